#pragma once
// The flags of one command: CLI11 takes the command line apart, this decides how values are read and how
// the help looks. Numbers are decimal (010 is ten), a flag may be given once unless it is a list.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace obscura {

class Flags {
  public:
    /// `usage` is what stands behind the program's name: "render [options] SCENE".
    Flags(std::string usage, std::string summary);

    /// Heading of the flags that follow.
    void group(std::string heading);

    // Each takes the names ("-t,--threads"), the place of the value, which keeps its value when the flag is
    // absent, and one sentence that states the unit. `shown` is the default in words.
    void on_off(const std::string& names, bool& target, const std::string& doc);
    void counted(const std::string& names, int& target, const std::string& doc);
    void text(const std::string& names, const std::string& value, std::string& target, const std::string& doc,
              const std::string& shown = "");
    void list(const std::string& names, const std::string& value, std::vector<std::string>& target,
              const std::string& doc);
    void whole(const std::string& names, const std::string& value, std::int64_t& target, std::int64_t low,
               std::int64_t high, const std::string& doc, const std::string& shown);
    void number(const std::string& names, const std::string& value, double& target, double low, double high,
                const std::string& doc, const std::string& shown);
    void positional(const std::string& name, std::string& target, const std::string& doc,
                    bool required = true);
    /// Text below the flags.
    void footer(std::string text);

    /// Reads the arguments that follow the command's name. False: help was asked for and printed to standard
    /// output. Throws UsageError.
    bool parse(const std::vector<std::string>& arguments);

    std::string help() const;

  private:
    /// How a flag appears on the command line: alone, alone and again, with a value, with a value and again;
    /// or as a value without a flag.
    enum class Form { on_off, counted, value, list, positional };
    /// What the command line gave: how often, and the values in order.
    struct Given {
        std::int64_t times = 0;
        std::vector<std::string> values;
    };
    struct Row {
        Form form = Form::on_off;
        std::string group, names, value, doc;
        std::function<void(const Given&)> read;  ///< every row's, once the whole line is taken apart
    };
    struct Line;

    void add(Form form, const std::string& names, const std::string& value, const std::string& doc,
             const std::string& shown, std::function<void(const Given&)> read);
    [[noreturn]] void reject(const std::string& message) const;
    const std::string& not_empty(const std::string& names, const std::string& text) const;
    void reject_leftovers(std::vector<std::string> left) const;

    std::string usage, summary, heading, closing;
    std::vector<Row> rows;
};

/// The flags that choose how to execute: -t, --threads and --isa, under a heading of their own.
void add_exec_flags(Flags& flags, std::int64_t& threads, std::string& isa);

/// Runs of words broken at `width` columns; lines after the first begin with `indent` spaces.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t width);

}  // namespace obscura
