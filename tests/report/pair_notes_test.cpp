// What is said of conflicts is what edited_system() does about them.

#include "app/report/pair_notes.h"

#include <gtest/gtest.h>

#include <string>

namespace obscura {
namespace {

Conflict conflict(ConflictKind kind, std::int64_t pixels, std::int64_t inherited) {
    Conflict c;
    c.kind = kind;
    c.pixels = pixels;
    c.inherited = inherited;
    c.worst_px = 2;
    c.what = "ball at the left";
    return c;
}

/// The only note about conflicts.
std::string note(const std::vector<Conflict>& conflicts, const StereoSettings& settings) {
    StereoPair pair;
    pair.edited.conflicts = conflicts;
    pair.solution.report.converged = true;
    const std::vector<std::string> notes = stereo_notes(pair, settings);
    EXPECT_EQ(notes.size(), 1u);
    return notes.empty() ? "" : notes[0];
}

constexpr auto window = ConflictKind::window_violation;

TEST(PairNotes, WindowViolationsOfTheRigAloneAreLeft) {
    StereoSettings settings;
    const std::string begin = "window violation: 10 pixels, worst by 2.00 px (ball at the left); ";
    EXPECT_EQ(note({conflict(window, 10, 10)}, settings),
              begin + "10 of them without edits, too; left as it is");
    EXPECT_EQ(note({conflict(window, 10, 7)}, settings),
              begin + "7 of them without edits, too; 3 held back before solving, 7 left as they are");
    EXPECT_EQ(note({conflict(window, 10, 0)}, settings), begin + "held back before solving");
    EXPECT_EQ(
        note({conflict(window, 6, 1), conflict(window, 4, 0)}, settings),
        "window violation: 10 pixels, worst by 2.00 px (ball at the left, and 1 more); 1 of them without "
        "edits, too; 9 held back before solving, 1 left as it is");
    settings.edit.window_inherited = true;
    EXPECT_EQ(note({conflict(window, 10, 7)}, settings),
              begin + "7 of them without edits, too; held back before solving");
    settings.edit.window_weight = 0;
    EXPECT_EQ(note({conflict(window, 10, 7)}, settings),
              begin + "7 of them without edits, too; left as it is");
}

TEST(PairNotes, TheComfortZoneHoldsBackWhateverIsOutside) {
    StereoSettings settings;
    const std::string begin =
        "outside comfort zone: 1 pixel, worst by 2.00 px (ball at the left); 1 of them without edits, too; ";
    EXPECT_EQ(note({conflict(ConflictKind::comfort, 1, 1)}, settings), begin + "held back before solving");
    settings.edit.comfort_weight = 0;
    EXPECT_EQ(note({conflict(ConflictKind::comfort, 1, 1)}, settings), begin + "left as it is");
}

TEST(PairNotes, ARemapHoldsNothingBack) {
    StereoSettings settings;
    settings.remap.kind = RemapKind::linear;
    for (const ConflictKind kind :
         {ConflictKind::depth_inversion, window, ConflictKind::comfort, ConflictKind::fold})
        EXPECT_NE(note({conflict(kind, 3, 0)}, settings).find("; before the remap"), std::string::npos);
}

}  // namespace
}  // namespace obscura
