// What the project aims at, and what a run reached.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "bench/diffraction/report.h"

namespace obscura {
namespace {

using Take = std::function<bool(const DiffractionRow&)>;

/// The worst of some numbers, and where it was found.
struct Worst {
    std::optional<double> value;
    std::string where;

    void least(double candidate, const DiffractionRow& row) {
        if (!value || candidate < *value) set(candidate, row);
    }
    void largest(double candidate, const DiffractionRow& row) {
        if (!value || candidate > *value) set(candidate, row);
    }
    void set(double candidate, const DiffractionRow& row) {
        value = candidate;
        where = fmt::format("{} {}", row.aperture, row.size);
        if (row.method != automatic_name) where += ", " + row.method;
    }
};

struct Goal {
    std::string what;
    double limit = 0;
    bool at_least = true;
    Worst reached;           ///< with one thread
    Worst reached_threaded;  ///< with the most threads
};

/// A peer's time over one of ours.
struct Ratio {
    const char* peer;
    const char* ours = automatic_name;
};

/// Its least value.
Worst least_ratio(const std::vector<DiffractionRow>& rows, const Take& take, Ratio ratio, int threads) {
    Worst worst;
    for (const DiffractionRow& row : rows) {
        if (row.threads != threads || row.method != ratio.ours || row.time.calls == 0 || !take(row)) continue;
        const double peer_ms = least_ms(rows, row, ratio.peer, false);
        if (peer_ms > 0) worst.least(peer_ms / row.time.least_ms, row);
    }
    return worst;
}

/// Largest ratio of the automatic choice's time to that of the best strategy in a call of its own.
Worst largest_regret(const std::vector<DiffractionRow>& rows, const std::string& part, int threads) {
    Worst worst;
    for (const DiffractionRow& row : rows) {
        if (row.part != part || row.threads != threads || row.method != automatic_name || !row.one_call ||
            row.time.calls == 0)
            continue;
        double best = INFINITY;
        for (const DiffractionRow& other : rows) {
            const bool same = other.part == part && other.aperture == row.aperture &&
                              other.size == row.size && other.threads == threads;
            if (!same || other.peer || !other.one_call || !other.same_function ||
                other.method == automatic_name || other.time.calls == 0)
                continue;
            best = std::min(best, other.time.least_ms);
        }
        if (std::isfinite(best)) worst.largest(row.time.least_ms / best, row);
    }
    return worst;
}

Worst largest_error(const std::vector<DiffractionRow>& rows, bool is_near) {
    Worst worst;
    for (const DiffractionRow& row : rows) {
        if (row.peer || !row.same_function || (row.part == near_part) != is_near || row.error < 0) continue;
        worst.largest(row.error, row);
    }
    return worst;
}

Worst least_psnr(const std::vector<DiffractionRow>& rows) {
    Worst worst;
    for (const DiffractionRow& row : rows) {
        if (row.part == far_part && !row.peer && row.same_function && row.log_psnr_db >= 0)
            worst.least(row.log_psnr_db, row);
    }
    return worst;
}

int most_threads(const std::vector<DiffractionRow>& rows) {
    int most = 1;
    for (const DiffractionRow& row : rows)
        most = std::max(most, row.threads);
    return most;
}

std::vector<Goal> speed_goals(const std::vector<DiffractionRow>& rows) {
    const Take convex = [](const DiffractionRow& row) {
        return row.part == far_part && !row.one_call && row.convex;
    };
    const Take whirl = [](const DiffractionRow& row) {
        return row.part == far_part && !row.one_call && row.aperture == "whirl";
    };
    const Take telescope = [](const DiffractionRow& row) {
        return row.part == far_part && !row.one_call && (row.aperture == "jwst" || row.aperture == "keck");
    };
    const Take window = [](const DiffractionRow& row) { return row.part == window_part && row.size >= 1024; };
    const Take any_window = [](const DiffractionRow& row) { return row.part == window_part; };
    const Take near = [](const DiffractionRow& row) { return row.part == near_part; };
    const int threads = most_threads(rows);
    std::vector<Goal> goals;
    const auto add = [&](std::string what, double limit, const Take& take, Ratio ratio) {
        goals.push_back({std::move(what), limit, true, least_ratio(rows, take, ratio, 1),
                         least_ratio(rows, take, ratio, threads)});
    };
    add("far field, convex: faster than FFTW of the image", 4, convex, {fftw_image_name});
    add("far field, convex: faster than FFTW of the mask", 1.5, convex, {fftw_mask_name});
    add("far field, whirl: faster than FFTW of the image", 3, whirl, {fftw_image_name});
    add("far field, whirl: faster than FFTW of the mask", 0.9, whirl, {fftw_mask_name});
    add("far field, telescopes: faster than FFTW of the image", 0, telescope, {fftw_image_name});
    add("far field, telescopes: faster than FFTW of the mask", 0, telescope, {fftw_mask_name});
    add("far field, convex, method runs without the planner: faster than FFTW of the mask", 0, convex,
        {fftw_mask_name, "runs"});
    add("zoomed window, masks of 512 and more: faster than padded FFTW", 10, window, {fftw_padded_name});
    add("zoomed window, all sizes: faster than padded FFTW", 10, any_window, {fftw_padded_name});
    add("near field: faster than FFTW's convolution", 5, near, {fftw_near_name});
    return goals;
}

std::vector<Goal> all_goals(const DiffractionResults& results) {
    const std::vector<DiffractionRow>& rows = results.rows;
    const int threads = most_threads(rows);
    std::vector<Goal> goals = speed_goals(rows);
    for (const char* part : {far_part, window_part, near_part}) {
        goals.push_back({fmt::format("{}: automatic choice, time over the best strategy's", part), 1.2, false,
                         largest_regret(rows, part, 1), largest_regret(rows, part, threads)});
    }
    goals.push_back({"far field and windows: amplitude error, share of F(0, 0)",
                     1e-6,
                     false,
                     largest_error(rows, false),
                     {}});
    goals.push_back({"far field: log-power PSNR, dB", 125, true, least_psnr(rows), {}});
    Goal near{"near field, Fresnel numbers 1 to 50: error, share of the unit wave",
              2e-6,
              false,
              largest_error(rows, true),
              {}};
    for (const ControlRow& row : results.controls) {
        DiffractionRow at;
        at.aperture = "heptagon";
        at.size = row.size;
        at.method = fmt::format("Fresnel number {}", row.fresnel_number);
        near.reached.largest(row.our_error, at);
    }
    goals.push_back(std::move(near));
    return goals;
}

std::string number(const Worst& worst) {
    if (!worst.value) return "-";
    return *worst.value < 1e-3 ? fmt::format("{:.1e}", *worst.value) : fmt::format("{:.2f}", *worst.value);
}

}  // namespace

std::string goals_markdown(const DiffractionResults& results) {
    const int threads = most_threads(results.rows);
    std::string text = fmt::format(
        "## Goals\n\nOne thread; the worst case counts. The last column is for information: the same worst "
        "case with {} threads for both sides.\n\n| goal | aim | reached | worst case | met | {} threads "
        "|\n|---|--:|--:|---|---|--:|\n",
        threads, threads);
    for (const Goal& goal : all_goals(results)) {
        if (!goal.reached.value) continue;
        const bool met =
            goal.at_least ? *goal.reached.value >= goal.limit : *goal.reached.value <= goal.limit;
        const std::string aim =
            goal.limit > 0 ? fmt::format("{} {:g}", goal.at_least ? ">=" : "<=", goal.limit) : "none";
        fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} | {} |\n", goal.what, aim,
                       number(goal.reached), goal.reached.where,
                       goal.limit > 0 ? (met ? "met" : "**not met**") : "", number(goal.reached_threaded));
    }
    return text;
}

}  // namespace obscura
