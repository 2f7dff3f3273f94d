#include "app/cli/flags.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <deque>

#include "app/cli/flag_values.h"
#include "app/cli/messages.h"
#include "app/scene/schema.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr std::size_t left_width = 30, page_width = 100;
constexpr int most_threads = 1024;

std::string command_of(const std::string& usage) {
    return usage.substr(0, usage.find(' '));
}

/// "--threads" of "-t,--threads"; empty where there is no long name.
std::string long_name(const std::string& names) {
    return names.substr(std::min(names.find("--"), names.size()));
}

/// The column of the help that names a flag: "-t, --threads N"; long names stand below one another.
std::string left_column(const std::string& names, const std::string& value) {
    const std::size_t comma = names.find(',');
    std::string left = comma == std::string::npos && names.rfind("--", 0) == 0 ? "    " + names : names;
    if (comma != std::string::npos) left.insert(comma + 1, " ");
    return value.empty() ? left : left + " " + value;
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
    std::string out;
    std::size_t column = indent;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::size_t word = end - at;
        if (column > indent && column + 1 + word > width) {
            out += "\n" + std::string(indent, ' ');
            column = indent;
        } else if (column > indent) {
            out += ' ';
            ++column;
        }
        out.append(text, at, word);
        column += word;
        at = end + 1;
    }
    return out;
}

void add_exec_flags(Flags& flags, std::int64_t& threads, std::string& isa) {
    flags.group("Execution");
    flags.whole("-t,--threads", "N", threads, 0, most_threads, "Threads; 0 = all of the machine.", "0");
    flags.text("--isa", "ISA", isa,
               "Instruction set: auto, ref, sse2, avx2, avx512bw. The pixels do not depend on it.", "auto");
}

Flags::Flags(std::string usage_, std::string summary_)
    : usage(std::move(usage_)), summary(std::move(summary_)), heading("Options") {}

void Flags::group(std::string heading_) {
    heading = std::move(heading_);
}

void Flags::footer(std::string text) {
    closing = std::move(text);
}

void Flags::add(Form form, const std::string& names, const std::string& value, const std::string& doc,
                const std::string& shown, std::function<void(const Given&)> read) {
    rows.push_back({form, form == Form::positional ? "Arguments" : heading, names, value,
                    shown.empty() ? doc : doc + " [default: " + shown + "]", std::move(read)});
}

void Flags::on_off(const std::string& names, bool& target, const std::string& doc) {
    add(Form::on_off, names, "", doc, "", [&target](const Given& given) { target |= given.times > 0; });
}

void Flags::counted(const std::string& names, int& target, const std::string& doc) {
    add(Form::counted, names, "", doc, "", [&target](const Given& given) {
        target += static_cast<int>(std::min<std::int64_t>(given.times, 9));
    });
}

void Flags::text(const std::string& names, const std::string& value, std::string& target,
                 const std::string& doc, const std::string& shown) {
    add(Form::value, names, value, doc, shown, [=, this, &target](const Given& given) {
        if (given.times > 0) target = not_empty(names, given.values.back());
    });
}

void Flags::list(const std::string& names, const std::string& value, std::vector<std::string>& target,
                 const std::string& doc) {
    add(Form::list, names, value, doc, "", [=, this, &target](const Given& given) {
        if (given.times == 0) return;
        for (const std::string& one : given.values)
            not_empty(names, one);
        target = given.values;
    });
}

void Flags::whole(const std::string& names, const std::string& value, std::int64_t& target, std::int64_t low,
                  std::int64_t high, const std::string& doc, const std::string& shown) {
    add(Form::value, names, value, doc, shown, [=, &target](const Given& given) {
        if (given.times > 0) target = whole_number(long_name(names), given.values.back(), low, high);
    });
}

void Flags::number(const std::string& names, const std::string& value, double& target, double low,
                   double high, const std::string& doc, const std::string& shown) {
    add(Form::value, names, value, doc, shown, [=, &target](const Given& given) {
        if (given.times > 0) target = real_number(long_name(names), given.values.back(), low, high);
    });
}

void Flags::positional(const std::string& name, std::string& target, const std::string& doc, bool required) {
    add(Form::positional, name, "", doc, "", [=, this, &target](const Given& given) {
        if (given.times > 0) target = not_empty(name, given.values.back());
        if (required && given.times == 0) reject(name + " is missing");
    });
}

void Flags::reject(const std::string& message) const {
    throw UsageError(fmt::format("{} (see 'obscura {} --help')", message, command_of(usage)));
}

/// A text that was given: "" is not the same as nothing.
const std::string& Flags::not_empty(const std::string& names, const std::string& text) const {
    if (text.empty()) {
        const std::string flag = long_name(names);
        reject((flag.empty() ? names : flag) + " is empty");
    }
    return text;
}

/// What CLI11 could not place: unknown flags first, they explain stray values behind them.
void Flags::reject_leftovers(std::vector<std::string> left) const {
    std::erase(left, "--");
    const auto unknown = std::find_if(left.begin(), left.end(),
                                      [](const std::string& a) { return a.size() > 1 && a[0] == '-'; });
    if (unknown != left.end()) {
        const std::string name = unknown->substr(0, unknown->find('='));
        std::vector<std::string> known;
        for (const Row& row : rows) {
            if (!long_name(row.names).empty()) known.push_back(long_name(row.names));
        }
        reject(fmt::format("unknown flag '{}'{}", name, hint(name, known)));
    }
    if (!left.empty()) reject(fmt::format("unexpected argument '{}'", left.front()));
}

/// The rows in CLI11's terms, and where it puts what it finds.
struct Flags::Line {
    struct Place {
        CLI::Option* option = nullptr;
        bool on = false;
        std::int64_t count = 0;
        std::string value;
        std::vector<std::string> values;
    };

    explicit Line(const std::vector<Row>& rows) {
        app.set_help_flag();
        app.allow_extras();
        app.add_flag("-h,--help", help_wanted)->disable_flag_override();
        for (const Row& row : rows)
            add(row, places.emplace_back());
    }

    void add(const Row& row, Place& place) {
        switch (row.form) {
            case Form::on_off:
                place.option = app.add_flag(row.names, place.on)->disable_flag_override();
                break;
            case Form::counted:
                place.option = app.add_flag(row.names, place.count)->disable_flag_override();
                break;
            case Form::value:
            case Form::positional:
                place.option = app.add_option(row.names, place.value);
                break;
            case Form::list:
                place.option = app.add_option(row.names, place.values)->allow_extra_args(false);
                break;
        }
        if (!row.value.empty()) place.option->type_name(row.value);
    }

    static Given given(const Row& row, const Place& place) {
        const auto times = static_cast<std::int64_t>(place.option->count());
        if (row.form == Form::counted) return {place.count, {}};
        if (row.form == Form::on_off) return {place.on ? times : 0, {}};
        return {times, row.form == Form::list ? place.values : std::vector<std::string>{place.value}};
    }

    CLI::App app;
    std::deque<Place> places;  ///< of the rows, in their order; they stay where CLI11 knows them
    bool help_wanted = false;
};

bool Flags::parse(const std::vector<std::string>& arguments) {
    Line line(rows);
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    try {
        line.app.parse(reversed);
    } catch (const CLI::ParseError& e) {
        // CLI11 has exit codes of its own; for us a wrong flag is a wrong flag.
        reject(e.what());
    }
    if (line.help_wanted) {
        print(help());
        return false;
    }
    reject_leftovers(line.app.remaining());
    for (std::size_t i = 0; i < rows.size(); ++i)
        rows[i].read(Line::given(rows[i], line.places[i]));
    return true;
}

std::string Flags::help() const {
    std::string out = wrapped(summary, 0, page_width) + "\n\nUsage: obscura " + usage + "\n";
    std::vector<Row> all = rows;
    all.push_back({Form::on_off, "Help", "-h,--help", "", "Print this and stop.", {}});
    // Arguments first, then each group where it first appeared.
    std::stable_partition(all.begin(), all.end(), [](const Row& r) { return r.form == Form::positional; });
    std::string current;
    for (const Row& row : all) {
        if (row.group != current) out += "\n" + row.group + ":\n";
        current = row.group;
        std::string left = "  " + left_column(row.names, row.value);
        left += left.size() + 2 > left_width ? "\n" + std::string(left_width, ' ')
                                             : std::string(left_width - left.size(), ' ');
        out += left + wrapped(row.doc, left_width, page_width) + "\n";
    }
    if (!closing.empty()) out += "\n" + closing + "\n";
    return out;
}

}  // namespace obscura
