// What the project aims at, and what a run reached.

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "bench/stereo/report.h"

namespace obscura {
namespace {

enum class Aim { none, at_least, at_most };

struct Goal {
    std::string what;
    Aim aim = Aim::none;
    double limit = 0;
    std::optional<double> reached;
    std::string where;
    bool bound = false;  ///< the true value is at least as good: a peer did not get there in time

    void least(double value, const std::string& place) {
        if (!reached || value < *reached) reached = value, where = place;
    }
    void largest(double value, const std::string& place) {
        if (!reached || value > *reached) reached = value, where = place;
    }
    bool met() const { return aim == Aim::at_least ? *reached >= limit : *reached <= limit; }
};

std::string size_text(int width, int height) {
    return fmt::format("{} x {}", width, height);
}

/// The first iteration from which on the curve stays within the goal.
double needed_by(const std::vector<CurvePoint>& curve) {
    constexpr double never = std::numeric_limits<double>::infinity();
    double needed = never;
    for (const CurvePoint& point : curve) {
        if (!point.error.within_goal())
            needed = never;
        else if (needed == never)
            needed = point.step;
    }
    return needed;
}

/// multigrid with one thread at every size, or only at the largest.
std::vector<const StereoRow*> multigrid_rows(const StereoResults& results, bool largest_only) {
    std::vector<const StereoRow*> rows;
    for (const StereoRow& row : results.rows) {
        if (row.method != multigrid_name || row.threads != 1) continue;
        if (largest_only && !rows.empty() && rows.back()->width < row.width) rows.clear();
        rows.push_back(&row);
    }
    return rows;
}

void add_accuracy(const StereoResults& results, std::vector<Goal>& goals) {
    Goal needed{
        "base: iterations until the error stays below 0.05 px, rms below 0.02 px", Aim::at_most, 8, {}, {}};
    Goal taken{"base: iterations until its own estimate stops it", Aim::at_most, 8, {}, {}};
    Goal largest{"base: largest error then, px", Aim::at_most, stereo_goal_max_px, {}, {}};
    Goal rms{"base: rms error then, px", Aim::at_most, stereo_goal_rms_px, {}, {}};
    for (const StereoRow* row : multigrid_rows(results, false)) {
        const std::string where = size_text(row->width, row->height);
        needed.largest(needed_by(row->curve), where);
        taken.largest(row->iterations, where);
        largest.largest(row->error.max_px, where);
        rms.largest(row->error.rms_px, where);
    }
    goals.insert(goals.end(), {needed, taken, largest, rms});

    needed = {"every case: iterations until the error stays below the same", Aim::at_most, 12, {}, {}};
    taken = {"every case: iterations until its own estimate stops it", Aim::at_most, 12, {}, {}};
    largest = {"every case: largest error then, px", Aim::at_most, stereo_goal_max_px, {}, {}};
    rms = {"every case: rms error then, px", Aim::at_most, stereo_goal_rms_px, {}, {}};
    Goal low{"every case: largest error over its estimate", Aim::none, 0, {}, {}};
    for (const CaseRow& row : results.cases) {
        const std::string where = row.stereo_case + ", " + size_text(row.width, row.height);
        needed.largest(row.needed < 0 ? std::numeric_limits<double>::infinity() : row.needed, where);
        taken.largest(row.iterations, where);
        largest.largest(row.error.max_px, where);
        rms.largest(row.error.rms_px, where);
        if (row.estimate_max_px > 0) low.largest(row.error.max_px / row.estimate_max_px, where);
    }
    goals.insert(goals.end(), {needed, taken, largest, rms, low});
}

/// A peer's time over ours, without and with levels kept.
void add_peer(const StereoResults& results, const StereoRow& ours, const char* peer, double limit,
              std::vector<Goal>& goals) {
    const StereoRow* other = find_row(results, ours, peer, 1);
    if (other == nullptr || !(other->whole_ms > 0)) return;
    const std::string where = size_text(ours.width, ours.height);
    for (const bool kept : {false, true}) {
        Goal goal{
            fmt::format("faster than {}{}", peer, kept ? ", levels kept" : ""), Aim::at_least, limit, {}, {}};
        goal.least(other->whole_ms / (kept ? ours.kept_ms : ours.whole_ms), where);
        goal.bound = !other->problem.empty();
        goals.push_back(goal);
    }
}

/// Full solve over 1:8.
void add_previews(const StereoResults& results, const StereoRow& ours, std::vector<Goal>& goals) {
    double full_ms = 0;
    for (const PreviewRow& row : results.previews) {
        if (row.width != ours.width || row.height != ours.height || row.threads != 1) continue;
        if (row.way.empty()) full_ms = row.ms;
        if (row.reduction != 8 || !(full_ms > 0)) continue;
        goals.push_back({fmt::format("1:8, {}, with upsampling: faster than the full solve", row.way),
                         Aim::at_least, 10, full_ms / row.ms, size_text(row.width, row.height)});
    }
}

void add_speed(const StereoResults& results, const StereoRow& ours, std::vector<Goal>& goals) {
    const std::string where = size_text(ours.width, ours.height);
    const auto add = [&](std::string what, Aim aim, double limit, double value) {
        goals.push_back({std::move(what), aim, limit, value, where});
    };
    add("passes over memory, whole solve", Aim::at_most, 100, in_passes(results, ours, ours.whole_ms));
    add("passes over memory, levels kept", Aim::at_most, 100, in_passes(results, ours, ours.kept_ms));
    add("passes over memory, iterations alone", Aim::none, 0, in_passes(results, ours, ours.iterate_ms));
    if (const StereoRow* cascade = find_row(results, ours, cascade_name, 1)) {
        add("whole solve, time over the cascade's", Aim::at_most, 4, ours.whole_ms / cascade->whole_ms);
        add("levels kept, time over the cascade's", Aim::at_most, 4, ours.kept_ms / cascade->whole_ms);
        add("rms error of the cascade over ours", Aim::at_least, 100,
            cascade->error.rms_px / ours.error.rms_px);
    }
    add_peer(results, ours, cg_name, 50, goals);
    add_peer(results, ours, cg_ic_name, 0, goals);
    add_peer(results, ours, cholmod_name, 100, goals);
    if (const StereoRow* two = find_row(results, ours, multigrid_name, 2)) {
        add("2 threads against 1, whole solve", Aim::at_least, 1.5, ours.whole_ms / two->whole_ms);
        add("2 threads against 1, levels kept", Aim::at_least, 1.5, ours.kept_ms / two->kept_ms);
        add("2 threads against 1, iterations alone", Aim::none, 0, ours.iterate_ms / two->iterate_ms);
    }
    add_previews(results, ours, goals);
}

std::string number(double value) {
    if (value < 0.1) return fmt::format("{:.2g}", value);
    return value < 10 ? fmt::format("{:.2f}", value) : fmt::format("{:.0f}", value);
}

std::string aim_text(const Goal& goal) {
    if (goal.aim == Aim::none || !(goal.limit > 0)) return "none";
    return fmt::format("{} {:g}", goal.aim == Aim::at_least ? ">=" : "<=", goal.limit);
}

std::string met_text(const Goal& goal) {
    if (goal.aim == Aim::none || !(goal.limit > 0)) return "";
    if (goal.met()) return "met";
    return goal.bound ? "unknown" : "**not met**";
}

}  // namespace

std::string stereo_goals_markdown(const StereoResults& results) {
    std::vector<Goal> goals;
    add_accuracy(results, goals);
    for (const StereoRow* row : multigrid_rows(results, true))
        add_speed(results, *row, goals);
    std::string text =
        "## Goals\n\nMethod `multigrid` with its default tolerances; the worst counts. Times: one thread, "
        "the base case, whole calls that stop by themselves. *Levels kept*: an earlier solve with the same "
        "masks and weights left them.\n\n| goal | aim | reached | where | met |\n|---|--:|--:|---|---|\n";
    for (const Goal& goal : goals) {
        if (!goal.reached) continue;
        fmt::format_to(std::back_inserter(text), "| {} | {} | {}{} | {} | {} |\n", goal.what, aim_text(goal),
                       goal.bound ? "at least " : "", number(*goal.reached), goal.where, met_text(goal));
    }
    return text;
}

}  // namespace obscura
