#pragma once
// What the reports of all benches have in common.

#include <algorithm>
#include <string>
#include <vector>

#include "bench/harness/options.h"

namespace obscura {

/// Name that our rows carry beside those of peers.
inline constexpr const char* our_name = "Obscura";

/// Values of one column in the order of their first row.
template <class Row, class Value>
std::vector<Value> distinct(const std::vector<Row>& rows, Value Row::*column) {
    std::vector<Value> values;
    for (const Row& row : rows) {
        if (std::find(values.begin(), values.end(), row.*column) == values.end())
            values.push_back(row.*column);
    }
    return values;
}

/// Thread counts of rows, ascending.
template <class Row>
std::vector<int> thread_counts(const std::vector<Row>& rows) {
    std::vector<int> counts = distinct(rows, &Row::threads);
    std::sort(counts.begin(), counts.end());
    return counts;
}

/// "1 thread", "2 threads".
std::string threads_text(int threads);

/// Title of a page, and whether it tells of a quick run: of what is `small` then.
std::string report_head(const char* title, const char* small, const BenchOptions& options);

/// Throws UsageError where options.scene chose none of the subjects, of `kind`.
void check_chosen(bool any, const BenchOptions& options, const char* kind = "scene");

/// Makes the folder that options name, where there is none. Throws OutputError.
void make_output_folder(const BenchOptions& options);

/// A table or page, by the name of its file.
struct ReportFile {
    const char* name;
    std::string text;
};

/// Writes those that are not empty into options.out. Throws OutputError.
void write_files(const BenchOptions& options, const std::vector<ReportFile>& files);

}  // namespace obscura
