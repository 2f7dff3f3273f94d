#include "app/cli/flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/cli/flag_values.h"
#include "app/scene/schema.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr std::size_t left_width = 30, page_width = 100;
constexpr int most_threads = 1024;

std::string command_of(const std::string& usage) {
    return usage.substr(0, usage.find(' '));
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
    : usage(std::move(usage_)), summary(std::move(summary_)), heading("Options") {
    app.set_help_flag();
    app.allow_extras();
    app.add_flag("-h,--help", help_wanted)->disable_flag_override();
}

void Flags::group(std::string heading_) {
    heading = std::move(heading_);
}

void Flags::footer(std::string text) {
    closing = std::move(text);
}

CLI::Option* Flags::finish(CLI::Option* option, const std::string& names, const std::string& value,
                           const std::string& doc, const std::string& shown) {
    const std::size_t comma = names.find(',');
    std::string left = comma == std::string::npos && names.rfind("--", 0) == 0 ? "    " + names : names;
    if (comma != std::string::npos) left.insert(comma + 1, " ");
    if (!value.empty()) {
        left += " " + value;
        option->type_name(value);
    }
    rows.push_back({heading, left, shown.empty() ? doc : doc + " [default: " + shown + "]"});
    const std::size_t dashes = names.find("--");
    if (dashes != std::string::npos) long_names.push_back(names.substr(dashes));
    return option;
}

void Flags::on_off(const std::string& names, bool& target, const std::string& doc) {
    finish(app.add_flag(names, target), names, "", doc, "")->disable_flag_override();
}

void Flags::counted(const std::string& names, int& target, const std::string& doc) {
    const auto count = std::make_shared<std::int64_t>(0);
    finish(app.add_flag(names, *count), names, "", doc, "")->disable_flag_override();
    readers.push_back([count, &target] { target += static_cast<int>(std::min<std::int64_t>(*count, 9)); });
}

void Flags::text(const std::string& names, const std::string& value, std::string& target,
                 const std::string& doc, const std::string& shown) {
    finish(app.add_option(names, target), names, value, doc, shown);
}

void Flags::list(const std::string& names, const std::string& value, std::vector<std::string>& target,
                 const std::string& doc) {
    finish(app.add_option(names, target), names, value, doc, "")->allow_extra_args(false);
}

void Flags::whole(const std::string& names, const std::string& value, std::int64_t& target, std::int64_t low,
                  std::int64_t high, const std::string& doc, const std::string& shown) {
    const auto text = std::make_shared<std::string>();
    CLI::Option* option = finish(app.add_option(names, *text), names, value, doc, shown);
    const std::string flag = names.substr(std::min(names.find("--"), names.size()));
    readers.push_back([=, &target] {
        if (option->count() > 0) target = whole_number(flag, *text, low, high);
    });
}

void Flags::number(const std::string& names, const std::string& value, double& target, double low,
                   double high, const std::string& doc, const std::string& shown) {
    const auto text = std::make_shared<std::string>();
    CLI::Option* option = finish(app.add_option(names, *text), names, value, doc, shown);
    const std::string flag = names.substr(std::min(names.find("--"), names.size()));
    readers.push_back([=, &target] {
        if (option->count() > 0) target = real_number(flag, *text, low, high);
    });
}

void Flags::positional(const std::string& name, std::string& target, const std::string& doc, bool required) {
    CLI::Option* option = app.add_option(name, target);
    rows.push_back({"Arguments", name, doc});
    readers.push_back([=, this] {
        if (required && option->count() == 0) reject(name + " is missing");
    });
}

void Flags::reject(const std::string& message) const {
    throw UsageError(fmt::format("{} (see 'obscura {} --help')", message, command_of(usage)));
}

/// What CLI11 could not place: unknown flags first, they explain stray values behind them.
void Flags::reject_leftovers() const {
    std::vector<std::string> left = app.remaining();
    std::erase(left, "--");
    const auto unknown = std::find_if(left.begin(), left.end(),
                                      [](const std::string& a) { return a.size() > 1 && a[0] == '-'; });
    if (unknown != left.end()) {
        const std::string name = unknown->substr(0, unknown->find('='));
        reject(fmt::format("unknown flag '{}'{}", name, hint(name, long_names)));
    }
    if (!left.empty()) reject(fmt::format("unexpected argument '{}'", left.front()));
}

bool Flags::parse(const std::vector<std::string>& arguments) {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    try {
        app.parse(reversed);
    } catch (const CLI::ParseError& e) {
        // CLI11 has exit codes of its own; for us a wrong flag is a wrong flag.
        reject(e.what());
    }
    if (help_wanted) {
        const std::string text = help();
        std::fwrite(text.data(), 1, text.size(), stdout);
        return false;
    }
    reject_leftovers();
    for (const auto& read : readers)
        read();
    return true;
}

std::string Flags::help() const {
    std::string out = wrapped(summary, 0, page_width) + "\n\nUsage: obscura " + usage + "\n";
    std::vector<Row> all = rows;
    all.push_back({"Help", "-h, --help", "Print this and stop."});
    // Arguments first, then each group where it first appeared.
    std::stable_partition(all.begin(), all.end(), [](const Row& r) { return r.group == "Arguments"; });
    std::string current;
    for (const Row& row : all) {
        if (row.group != current) out += "\n" + row.group + ":\n";
        current = row.group;
        std::string left = "  " + row.left;
        left += left.size() + 2 > left_width ? "\n" + std::string(left_width, ' ')
                                             : std::string(left_width - left.size(), ' ');
        out += left + wrapped(row.doc, left_width, page_width) + "\n";
    }
    if (!closing.empty()) out += "\n" + closing + "\n";
    return out;
}

}  // namespace obscura
