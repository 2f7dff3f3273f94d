#pragma once
// What every run tells machines of itself, whatever it made.

#include <cstdint>
#include <string>

#include "app/report/json_writer.h"
#include "core/isa.h"

namespace obscura {

struct RunReport {
    std::string scene;
    Exec exec;
    int width = 0, height = 0, samples = 0;  ///< of the pictures that are written
    std::int64_t limit_mib = 0;
    double load_s = 0, total_s = 0;
};

/// Threads that run: those of `exec`, or all of the machine.
int thread_count(const Exec& exec);

/// Most memory this process ever held, bytes.
std::int64_t peak_resident_bytes();

// Members of the object that is open.

/// schema (1), program, scene.
void put_origin(JsonWriter& json, const RunReport& run);
/// isa, threads.
void put_execution(JsonWriter& json, const Exec& exec);
/// width_px, height_px, samples.
void put_picture_size(JsonWriter& json, const RunReport& run);
/// load_s, total_s.
void put_times(JsonWriter& json, const RunReport& run);

}  // namespace obscura
