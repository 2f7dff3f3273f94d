#pragma once
// The benches by name. A new one is a row in benches.cpp and a folder of its own.

#include <string>
#include <vector>

#include "bench/harness/options.h"

namespace obscura {

/// One bench, and what its command line says of it.
struct Bench {
    const char* name;
    const char* what;                ///< that it measures, in a few words
    const char* subjects;            ///< what BenchOptions::scene chooses among
    std::vector<const char*> data;   ///< what it finds in BenchOptions::data; empty: nothing
    std::vector<const char*> parts;  ///< that BenchOptions::part may name; empty: it has none
    /// Measures and writes tables and charts into options.out. Returns an exit code. Throws UsageError,
    /// InputError, OutputError.
    int (*run)(const BenchOptions& options);
};

const std::vector<Bench>& all_benches();

/// Null when there is none of that name.
const Bench* find_bench(const std::string& name);

/// Whether the bench has that part; all of it, the empty name, it always has.
bool has_part(const Bench& bench, const std::string& part);

// Texts of a help page.

/// "raster (what), shadows (what) or stereo (what)".
std::string benches_text();
/// "scenes (apertures, hard cases)".
std::string subjects_text();
/// "meshes, cities, apertures".
std::string data_text();
/// "shadows: times, accuracy or sizes".
std::string parts_text();

}  // namespace obscura
