// The page about a stereo pair: whole by itself, well formed, its pictures pictures, its numbers those of
// the pair.

#include "app/report/pair_page.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "app/report/inline_png.h"
#include "app/report/pair_charts.h"
#include "app/report/pair_pictures.h"
#include "core/error.h"
#include "core/image_io.h"
#include "lessons/drawing/markup.h"
#include "lessons/drawing/svg_chart.h"
#include "tests/pair/eyes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

constexpr const char* wild_name = "ball <script>alert(\"&'1\")</script>";

/// A ball before a wall, with edits that are at odds with each other.
struct Fixture {
    Scene scene = empty_scene(120, 80, 1);
    StereoSettings settings;
    StereoPair pair;
    StereoFrameReport frame;
    Fixture() {
        scene.materials.resize(1);
        add(scene, box({30, 8, 0.4}), 0, {0, 2, -7});
        add(scene, sphere(0.8, 32, 16), 0, {0, 1, -3});
        scene.mesh.objects[1].name = wild_name;
        scene.camera = {CameraKind::perspective, {0, 1.4, 1.5}, {0, 1.1, -5}, {0, 1, 0}, 42, 10, 0.05};
        scene.lights.push_back(directional({-0.5, -1, -0.7}, {2.5f, 2.4f, 2.2f}, 3));
        settings.rig.interaxial_m = 0.2;
        settings.rig.zero_parallax_m = 5;
        settings.middle_picture = true;
        settings.edit.comfort = {4, -4};
        const auto add_edit = [&](const char* name,
                                  std::variant<RoundnessEdit, AnchorEdit, InterfaceEdit, MatchEdit> what) {
            StereoEdit edit;
            edit.name = name;
            edit.what = std::move(what);
            settings.edits.push_back(std::move(edit));
        };
        add_edit("round & near", AnchorEdit{{{1}, {}}, -12});
        add_edit("a<b", AnchorEdit{{{0}, {}}, 12});
        settings.edit.anchor_weight = 1;
        StereoCache cache;
        render_stereo_pair(scene, settings, {}, {}, cache, pair);
        frame = frame_report(7, pair, settings);
    }
    std::string page() const {
        const Image<Vec3f> left = display_light(pair.eyes.left.radiance.view(), scene.render, {}),
                           right = display_light(pair.eyes.right.radiance.view(), scene.render, {});
        return stereo_report({scene, settings, pair, frame, "sc<ene>.toml", left, right}, {});
    }
};

const Fixture& fixture() {
    static const Fixture f;
    return f;
}
const std::string& page() {
    static const std::string text = fixture().page();
    return text;
}

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
        ++n;
    return n;
}

/// Elements that are not closed in order; empty: well formed.
std::string unbalanced(const std::string& html) {
    const std::set<std::string> known{
        "html",     "head",   "meta", "title", "style", "body", "main",   "header",     "section", "p",
        "h1",       "h2",     "div",  "span",  "b",     "i",    "figure", "figcaption", "img",     "table",
        "thead",    "tbody",  "tr",   "th",    "td",    "svg",  "rect",   "line",       "text",    "polygon",
        "polyline", "circle", "ul",   "li",    "dl",    "dt",   "dd"};
    std::vector<std::string> open;
    for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at)) {
        const std::size_t end = html.find('>', at);
        if (end == std::string::npos) return "a tag without end";
        const std::string tag = html.substr(at + 1, end - at - 1);
        at = end;
        if (tag == "!DOCTYPE html") continue;
        const bool closes = tag[0] == '/';
        const std::string name = closes ? tag.substr(1) : tag.substr(0, tag.find_first_of(" /"));
        if (known.count(name) == 0) return "unknown: " + name;
        if (count(tag, "\"") % 2 != 0) return "quotes of: " + name;
        if (closes) {
            if (open.empty() || open.back() != name) return "closed too early: " + name;
            open.pop_back();
        } else if (tag.back() != '/') {
            open.push_back(name);
        }
    }
    return open.empty() ? "" : "left open: " + open.back();
}

std::string decoded_base64(std::string_view text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    unsigned bits = 0;
    int held = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<unsigned>(digits.find(c));
        held += 6;
        if (held < 8) continue;
        held -= 8;
        out += static_cast<char>(bits >> held & 255u);
    }
    return out;
}

TEST(HtmlText, EscapesWhatHasAMeaning) {
    EXPECT_EQ(html_text("a<b>&\"c\"'d'"), "a&lt;b&gt;&amp;&quot;c&quot;&#39;d&#39;");
    EXPECT_EQ(html_text("Häuser\n\x01\x7f"), "Häuser\n\xef\xbf\xbd\xef\xbf\xbd");
}

TEST(HtmlText, Base64IsThatOfTheStandard) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(StereoReport, IsWellFormedAndWholeByItself) {
    EXPECT_EQ(unbalanced(page()), "");
    for (const char* outside :
         {"http:", "https:", "url(", "<script", "<link", "@import", "href", "srcset", "file:", "nan", "inf "})
        EXPECT_EQ(page().find(outside), std::string::npos) << outside;
    EXPECT_EQ(count(page(), "src="), count(page(), "src=\"data:image/png;base64,"));
    EXPECT_NE(page().find("prefers-color-scheme:dark"), std::string::npos);
}

TEST(StereoReport, PicturesDecode) {
    const std::string mark = "src=\"data:image/png;base64,";
    int pictures = 0;
    for (std::size_t at = page().find(mark); at != std::string::npos; at = page().find(mark, at + 1)) {
        const std::size_t begin = at + mark.size();
        const std::string png =
            decoded_base64(std::string_view(page()).substr(begin, page().find('"', begin) - begin));
        const Image<Rgba8> picture = decode_png(png, "inline");
        // The scale is a strip; all others are as large as the picture.
        EXPECT_TRUE(picture.width == 640 || (picture.width == 120 && picture.height == 80)) << picture.width;
        ++pictures;
    }
    EXPECT_EQ(pictures, 7);  // two maps, their scale, two anaglyphs, conflicts of the edits and what is left
}

TEST(StereoReport, NamesAreTextNotTags) {
    EXPECT_EQ(page().find(wild_name), std::string::npos);
    EXPECT_NE(page().find(html_text(wild_name)), std::string::npos);  // in conflicts
    EXPECT_NE(page().find("round &amp; near"), std::string::npos);
    EXPECT_NE(page().find("a&lt;b"), std::string::npos);
    EXPECT_NE(page().find("sc&lt;ene&gt;.toml"), std::string::npos);
}

TEST(StereoReport, TellsTheNumbersOfThePair) {
    const Fixture& f = fixture();
    ASSERT_FALSE(f.frame.conflicts.empty());
    for (const Conflict& c : f.frame.conflicts)
        EXPECT_NE(page().find(fmt::format(
                      "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{:.2f} px</td>",
                      c.pixels, c.inherited, c.worst_px)),
                  std::string::npos)
            << c.what;
    ASSERT_FALSE(f.frame.solve.unsatisfied.empty());
    for (const Unsatisfied& u : f.frame.solve.unsatisfied)
        EXPECT_NE(page().find(fmt::format("<td class=\"n\">{:.2f} px</td><td class=\"n\">{:.2f} px</td><td "
                                          "class=\"n\">{:.2f} px</td><td class=\"n\">{}</td>",
                                          u.wanted_px, u.reached_px, u.worst_px, u.pixels)),
                  std::string::npos)
            << u.name;
    EXPECT_NE(page().find(fmt::format("{} triangles became {} in", f.frame.reprojection.triangles_in,
                                      f.frame.reprojection.triangles_out)),
              std::string::npos);
    EXPECT_NE(page().find("frame 7"), std::string::npos);
    EXPECT_NE(page().find("0.00 %</span>"), std::string::npos);
    EXPECT_NE(page().find("0.00°</span>"), std::string::npos);
    EXPECT_NE(page().find("-4.00 px (-3.33 %) to 4.00 px (3.33 %)"), std::string::npos);
    // One dot per iteration that has an estimate.
    std::size_t dots = 0;
    for (const SolveStep& s : f.frame.solve.steps)
        dots += (s.residual > 0 ? 1u : 0u) + (s.error_max_px > 0 ? 1u : 0u) + (s.error_rms_px > 0 ? 1u : 0u);
    EXPECT_EQ(count(page(), "<circle"), dots);
    EXPECT_GT(dots, 6u);
}

TEST(StereoReport, TellsWhatIsLeftInTheOptimisedMap) {
    const Fixture& f = fixture();
    const Conflicts left = remaining_conflicts(f.scene, f.settings, f.pair, {});
    ASSERT_FALSE(left.list.empty());
    const std::size_t at = page().find("<h2>Conflicts that are left</h2>");
    ASSERT_NE(at, std::string::npos);
    for (const Conflict& c : left.list)
        EXPECT_NE(page().find(fmt::format("<td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>",
                                          html_text(c.what), c.pixels, c.inherited),
                              at),
                  std::string::npos)
            << c.what;
    EXPECT_NE(page().find(fmt::format(
                  "<b>{}</b><span>pixels in conflict after solving</span>",
                  left.count(ConflictKind::depth_inversion) + left.count(ConflictKind::window_violation) +
                      left.count(ConflictKind::comfort) + left.count(ConflictKind::fold))),
              std::string::npos);
}

TEST(StereoReport, HistogramCountsEveryPixelOnce) {
    const Fixture& f = fixture();
    const DisparityHistogram h = disparity_histogram(f.pair.view, f.pair.optimised, f.settings.edit.comfort);
    double before = 0, after = 0, near = 0, seen = 0;
    for (std::size_t i = 0; i < h.after.size(); ++i) {
        before += h.before[i];
        after += h.after[i];
    }
    EXPECT_NEAR(before, 1, 1e-9);
    EXPECT_NEAR(after, 1, 1e-9);
    for (int y = 0; y < 80; ++y) {
        for (int x = 0; x < 120; ++x) {
            const int column = x + f.pair.view.margin_px;
            if (f.pair.view.object(column, y) == nothing_seen) continue;
            seen += 1;
            near += f.pair.view.disparity(column, y) > 4.05f ? 1 : 0;
        }
    }
    // Below the wall there is nothing.
    EXPECT_LT(seen, 120 * 80);
    EXPECT_EQ(static_cast<double>(h.pixels), seen);
    EXPECT_NEAR(h.near_percent_before, 100 * near / seen, 1e-6);
    EXPECT_GE(h.first_px, -1e6);
}

TEST(SvgChart, WritesShapesAndEscapesWords) {
    SvgChart chart(40, 20, "a < b");
    chart.text({1, 2}, Align::right, "tick", "<&>");
    chart.box({0, 1.25, 3, 4}, "zone");
    chart.polyline({{0, 0}, {1, 2.5}}, "rms curve");
    EXPECT_EQ(chart.markup(),
              "<svg viewBox=\"0 0 40 20\" role=\"img\" aria-label=\"a &lt; b\" "
              "preserveAspectRatio=\"xMidYMid meet\">"
              "<text x=\"1.0\" y=\"2.0\" text-anchor=\"end\" class=\"tick\">&lt;&amp;&gt;</text>"
              "<rect x=\"0.0\" y=\"1.2\" width=\"3.0\" height=\"4.0\" class=\"zone\"/>"
              "<polyline points=\"0.0,0.0 1.0,2.5\" class=\"rms curve\"/></svg>");
}

TEST(StereoReport, TicksAreRoundNumbers) {
    EXPECT_EQ(round_ticks(-1, 1, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
    EXPECT_EQ(round_ticks(0, 23, 5).size(), 5u);  // 0 5 10 15 20
}

TEST(StereoReport, SaysSoWhereThereIsNothingToTell) {
    Fixture f;
    f.frame.conflicts.clear();
    f.frame.solve = {};
    f.frame.realised = f.frame.left = f.frame.right = {};
    const std::string text = stereo_report({f.scene, f.settings, f.pair, f.frame, "s", {}, {}}, {});
    EXPECT_EQ(unbalanced(text), "");
    EXPECT_NE(text.find("None: the edits keep"), std::string::npos);
    EXPECT_NE(text.find("None: everything is within"), std::string::npos);
    EXPECT_NE(text.find("makes no estimates"), std::string::npos);
    EXPECT_NE(text.find("Not measured"), std::string::npos);
    EXPECT_EQ(count(text, "anaglyph before"), 0u);
}

}  // namespace
}  // namespace obscura
