// Bad scenes: each is refused with one exact message that says where and, if possible, what was meant.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/scene/scene_file.h"
#include "app/scene/schema.h"
#include "core/error.h"

namespace obscura {
namespace {

/// What reading `text` throws as InputError; "" when it throws none.
std::string input_error(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
        read_scene_text(text, "s.toml", overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

struct BadScene {
    const char* name;
    std::string text;
    std::string message;
};

std::string scene(const std::string& rest) {
    return "format = 1\ncamera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}\n" + rest;
}
std::string camera(const std::string& keys) {
    return "format = 1\n[camera]\n" + keys;
}
std::string light(const std::string& keys) {
    return scene("[[light]]\nid = \"sun\"\n" + keys);
}
std::string sun_with(const std::string& keys) {
    return light("type = \"sun\"\nlatitude_deg = 0\nlongitude_deg = 0\ntime = 2026-06-21T12:00:00Z\n" + keys);
}

const std::vector<BadScene>& bad_scenes() {
    static const std::string directional = "type = \"directional\"\nazimuth_deg = 0\nelevation_deg = 45\n";
    static const std::string box = "[[mesh]]\nid = \"a\"\nshape = \"box\"\n";
    static const std::vector<BadScene> all = {
        {"Empty", "", "s.toml: no camera: the scene is empty"},
        {"NoCamera", "format = 1", "s.toml: no camera: the scene needs [camera]"},
        {"WrongVersion", scene("").replace(9, 1, "2"), "s.toml:1:10: 'format' must be one of 1, not 2"},
        {"Nul", scene(std::string("x\0", 2)), "s.toml:3:2: NUL byte: this is not a text file"},
        {"BrokenUtf8", scene("# caf\xE9 au lait"), "s.toml:3:6: byte 0xE9 is not valid UTF-8"},
        {"OverlongUtf8", scene("# \xC0\xAF"), "s.toml:3:3: byte 0xC0 is not valid UTF-8"},
        {"SurrogateUtf8", scene("# \xED\xA0\x80"), "s.toml:3:3: byte 0xED is not valid UTF-8"},
        {"DuplicateKey", camera("eye_m = [0, 1, 5]\neye_m = [0, 1, 6]"),
         "s.toml:4:9: in key-value pair: cannot redefine existing array 'eye_m'"},
        {"UnknownKey", camera("eye_m = [0, 1, 5]\nlook_at_m = [0, 0, 0]\nvfo_deg = 30"),
         "s.toml:5:1: unknown key 'vfo_deg' in [camera]; did you mean 'vfov_deg'?"},
        {"UnknownKeyWithoutHint", scene("[render]\nspectral = true"),
         "s.toml:4:1: unknown key 'spectral' in [render]"},
        {"UnknownSection", scene("[[lihgt]]\n"), "s.toml:3:3: unknown key 'lihgt'; did you mean 'light'?"},
        {"MissingKey", camera("eye_m = [0, 1, 5]"), "s.toml:2:1: [camera] needs 'look_at_m'"},
        {"MissingType", light(""),
         "s.toml:3:1: [[light]] needs 'type': one of \"directional\", \"sun\", \"point\", \"spot\", "
         "\"area\", \"surface\""},
        {"WrongType", camera("eye_m = [0, 1]"), "s.toml:3:9: 'eye_m' must be three numbers, not a list of 2"},
        {"TextForTable", "format = 1\ncamera = \"front\"",
         "s.toml:2:10: 'camera' must be a table [camera], not the string \"front\""},
        {"TableForList", scene("[mesh]\nid = \"a\""),
         "s.toml:3:1: 'mesh' must be a list of tables [[mesh]], not a table"},
        {"QuotedUnit", camera("vfov_deg = \"45 deg\""),
         "s.toml:3:12: 'vfov_deg' must be a number of degrees, not the string \"45 deg\"; write 45 without "
         "quotes, the unit stands in the key's name"},
        {"BareUnit", camera("vfov_deg = 45 deg"),
         "s.toml:3:15: in key-value pair: expected a comment or whitespace, saw 'd' (a value is a plain "
         "number: its unit stands in the key's name)"},
        {"NotANumber", camera("vfov_deg = nan"), "s.toml:3:12: 'vfov_deg' must be finite, not nan"},
        {"Infinite", camera("near_m = inf"), "s.toml:3:10: 'near_m' must be finite, not inf"},
        {"InfiniteComponent", camera("eye_m = [0, -inf, 5]"),
         "s.toml:3:13: 'eye_m' must be finite, not -inf"},
        {"HugeNumber", camera("vfov_deg = 1e400"),
         "s.toml:3:17: in floating-point: '1e400' could not be interpreted as a value"},
        {"FovZero", camera("vfov_deg = 0"), "s.toml:3:12: 'vfov_deg' must be in [1e-06, 180), not 0"},
        {"Fov180", camera("vfov_deg = 180.0"), "s.toml:3:12: 'vfov_deg' must be in [1e-06, 180), not 180"},
        {"EyeIsTarget", camera("eye_m = [1, 2, 3]\nlook_at_m = [1.0, 2, 3]"),
         "s.toml:4:13: 'look_at_m' is the same point as 'eye_m'"},
        {"UpIsView", camera("eye_m = [0, 9, 0]\nlook_at_m = [0, 0, 0]"),
         "s.toml:4:13: 'up' is parallel to the view from 'eye_m' to 'look_at_m'; give another 'up'"},
        {"NoUp", camera("eye_m = [0, 9, 0]\nlook_at_m = [0, 0, 0]\nup = [0, 0, 0]"),
         "s.toml:5:6: 'up' has no direction"},
        {"TwoLenses", camera("eye_m = [0, 1, 5]\nlook_at_m = [0, 0, 0]\nvfov_deg = 30\nfocal_length_mm = 50"),
         "s.toml:6:19: give either 'vfov_deg' or 'focal_length_mm', not both"},
        {"SensorWithoutLens", camera("eye_m = [0, 1, 5]\nlook_at_m = [0, 0, 0]\nsensor_height_mm = 24"),
         "s.toml:5:20: 'sensor_height_mm' needs 'focal_length_mm'"},
        {"KeyOfOtherKind", camera("eye_m = [0, 1, 5]\nlook_at_m = [0, 0, 0]\nheight_m = 3"),
         "s.toml:5:1: 'height_m' does not apply to [camera] with projection = \"perspective\""},
        {"UnknownChoice", light("type = \"dirctional\""),
         "s.toml:5:8: 'type' must be one of \"directional\", \"sun\", \"point\", \"spot\", \"area\", "
         "\"surface\", not \"dirctional\"; did you mean 'directional'?"},
        {"UnlistedInteger", scene("[render]\nsamples = 2"),
         "s.toml:4:11: 'samples' must be one of 1, 4, 16, not 2"},
        {"IntegerWanted", scene("[render]\nsamples = 4.0"),
         "s.toml:4:11: 'samples' must be an integer, not a number"},
        {"AreaWithoutSize",
         light("type = \"area\"\nposition_m = [0, 3, 0]\nlook_at_m = [0, 0, 0]\nradiance_w_m2_sr = "
               "5\nwidth_m = 0"),
         "s.toml:9:11: 'width_m' must be in (0, 1000000000], not 0"},
        {"AreaWithoutAWay",
         light("type = \"area\"\nposition_m = [0, 3, 0]\nlook_at_m = [0, 3, 0]\nradiance_w_m2_sr = 5"),
         "s.toml:7:13: 'look_at_m' is nearer to 'position_m' than 1e-06 m"},
        {"PointsOfALight", light(directional + "angular_diameter_deg = 1\nshadow.samples = 100"),
         "s.toml:9:18: 'samples' must be one of 1, 4, 16, 64, 256, 1024 or \"auto\", not 100"},
        {"SkyWithoutSun", scene("[sky]\nmodel = \"clear\""),
         "s.toml:4:9: 'model' = \"clear\" needs a light of type \"sun\" or \"directional\" to follow"},
        {"SkyOfNoLight", light(directional + "[sky]\nmodel = \"clear\"\nsun = \"moon\""),
         "s.toml:10:7: there is no light 'moon'"},
        {"SkyWithoutImage", scene("[sky]\nmodel = \"image\""),
         "s.toml:4:9: 'model' = \"image\" needs 'file'"},
        {"ImageOfAGradient", scene("[sky]\nfile = \"a.pfm\""),
         "s.toml:4:8: 'file' needs 'model' = \"image\""},
        {"ScaleOfAGradient", scene("[sky]\nfile_scale = 2"),
         "s.toml:4:14: 'file_scale' needs 'model' = \"image\""},
        {"SunOfAnImage", scene("[sky]\nmodel = \"image\"\nfile = \"a.pfm\"\nsun = \"moon\""),
         "s.toml:6:7: 'sun' needs 'model' = \"clear\" or \"overcast\""},
        {"ShadowResolution", light(directional + "shadow.resolution = 1000"),
         "s.toml:8:21: 'resolution' must be one of 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, "
         "32768, 65536, 131072, 262144, 524288, 1048576 or \"auto\", not 1000"},
        {"ShadowResolutionTooHigh", light(directional + "shadow.resolution = 2097152"),
         "s.toml:8:21: 'resolution' must be one of 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, "
         "32768, 65536, 131072, 262144, 524288, 1048576 or \"auto\", not 2097152"},
        {"ShadowResolutionWord", light(directional + "shadow.resolution = \"best\""),
         "s.toml:8:21: 'resolution' must be an integer or \"auto\", not the string \"best\""},
        {"DenseAuto", light(directional + "shadow = {method = \"map\", resolution = \"auto\"}"),
         "s.toml:8:40: 'resolution' = \"auto\" needs method = \"compressed\" or \"stack\""},
        {"DenseTooHigh", light(directional + "shadow = {resolution = 32768, method = \"map\"}"),
         "s.toml:8:24: 'resolution' must be at most 16384 with method = \"map\""},
        {"DenseScope", light(directional + "[shadow.sun]\nmethod = \"map\"\nscope = \"full\""),
         "s.toml:10:1: 'scope' needs method = \"compressed\""},
        {"DenseFilter", light(directional + "[shadow.sun]\nmethod = \"map\"\nfilter = \"hierarchical\""),
         "s.toml:10:1: 'filter' needs method = \"compressed\""},
        {"DenseCache", light(directional + "[shadow.sun]\nmethod = \"map\"\ncache = \"c\""),
         "s.toml:10:1: 'cache' needs method = \"compressed\" or \"stack\""},
        {"StackWithoutSize", light(directional + "[shadow.sun]\nmethod = \"stack\""),
         "s.toml:9:10: method = \"stack\" needs a light with a size, which light 'sun' has not"},
        {"StackOfAuto",
         light(directional + "angular_diameter_deg = 1\n[shadow.sun]\nmethod = \"stack\"\n"
                             "samples = \"auto\""),
         "s.toml:11:11: 'samples' = \"auto\" needs method = \"exact\""},
        {"StackOfOne",
         light(directional + "angular_diameter_deg = 1\n[shadow.sun]\nmethod = \"stack\"\n"
                             "samples = 1"),
         "s.toml:11:11: 'samples' must be at least 4 with method = \"stack\", not 1"},
        {"StackOfNoPower",
         light(directional + "angular_diameter_deg = 1\n[shadow.sun]\nmethod = \"stack\"\n"
                             "samples = 100"),
         "s.toml:11:11: 'samples' must be one of 1, 4, 16, 64, 256, 1024 or \"auto\", not 100"},
        {"StackTooFine",
         light(directional + "angular_diameter_deg = 1\n[shadow.sun]\nmethod = \"stack\"\n"
                             "resolution = 131072"),
         "s.toml:11:14: 'resolution' must be at most 65536 with method = \"stack\""},
        {"StackScope",
         light(directional + "angular_diameter_deg = 1\n[shadow.sun]\nmethod = \"stack\"\n"
                             "scope = \"full\""),
         "s.toml:11:1: 'scope' needs method = \"compressed\""},
        {"StackFilter",
         light(directional + "angular_diameter_deg = 1\n[shadow.sun]\nmethod = \"stack\"\n"
                             "filter_px = 3"),
         "s.toml:11:1: 'filter_px' needs method = \"map\" or \"compressed\""},
        {"StackMagnification",
         light(directional + "angular_diameter_deg = 1\n[shadow.sun]\nmethod = \"stack\"\n"
                             "resolution = 512\nmax_magnification = 2"),
         "s.toml:12:1: 'max_magnification' needs resolution = \"auto\""},
        {"CacheOfFrames", light(directional + "[shadow.sun]\nscope = \"frame\"\ncache = \"c\""),
         "s.toml:10:1: 'cache' needs scope = \"full\""},
        {"UnshadowedScope", light(directional + "[shadow.sun]\nmethod = \"none\"\nscope = \"full\""),
         "s.toml:10:1: 'scope' needs method = \"compressed\""},
        {"FixedMagnification", light(directional + "[shadow.sun]\nresolution = 512\nmax_magnification = 2"),
         "s.toml:10:1: 'max_magnification' needs resolution = \"auto\""},
        {"DenseFilterSide", light(directional + "[shadow.sun]\nmethod = \"map\"\nfilter_px = 7"),
         "s.toml:10:13: 'filter_px' must be 1, 3 or 5 with method = \"map\", not 7"},
        {"EvenFilterSide", light(directional + "[shadow.sun]\nfilter_px = 4"),
         "s.toml:9:13: 'filter_px' must be one of 1, 3, 5, 7, 9, 11, 13, 15, not 4"},
        {"CacheOfNoName", light(directional + "[shadow]\ncache = \"\""),
         "s.toml:9:9: 'cache' must name a folder"},
        {"CacheOfNoNameOfOne", light(directional + "[shadow.sun]\ncache = \"\""),
         "s.toml:9:9: 'cache' must name a folder"},
        {"CacheIsNoNumber", light(directional + "[shadow]\ncache = 3"),
         "s.toml:9:9: 'cache' must be a string, not an integer"},
        {"ShadowKeyForAll", light(directional + "[shadow]\nresolution = 512"),
         "s.toml:9:14: 'shadow' must be tables [shadow.NAME], not an integer"},
        {"UnknownLayout", light(directional + "shadow.layout = \"words32\""),
         "s.toml:8:17: 'layout' must be one of \"words24\", \"words16\", \"bytes16\", not \"words32\"; did "
         "you mean 'words24'?"},
        {"UnknownCode", light(directional + "shadow.code = \"tree\""),
         "s.toml:8:15: 'code' must be one of \"auto\", \"mh\", \"mmh\", \"dag\", \"facet\", not \"tree\""},
        {"LayoutOfMergedTrees", light(directional + "shadow = {code = \"mmh\", layout = \"words16\"}"),
         "s.toml:8:25: 'layout' needs code = \"mh\""},
        {"PartsOfMergedTrees", light(directional + "shadow = {code = \"mmh\", scope = \"frame\"}"),
         "s.toml:8:11: 'code' = \"mmh\" needs scope = \"full\""},
        {"TopLevels", light(directional + "shadow.top_levels = 11"),
         "s.toml:8:21: 'top_levels' must be in [0, 10], not 11"},
        {"NoMagnification", light(directional + "shadow.max_magnification = 0"),
         "s.toml:8:28: 'max_magnification' must be in [0.01, 100], not 0"},
        {"DuplicateMesh", scene(box + box), "s.toml:7:6: two mesh entries have the id 'a' (first in line 4)"},
        {"DuplicateLight", light(directional + "[[light]]\nid = \"sun\"\n" + directional),
         "s.toml:9:6: two light entries have the id 'sun' (first in line 4)"},
        {"DanglingMaterial", scene(box + "material = \"ston\"\n[material.stone]"),
         "s.toml:6:12: there is no material 'ston'; did you mean 'stone'?"},
        {"DanglingSlot", scene(box + "materials = {default = \"ston\"}\n[material.stone]"),
         "s.toml:6:24: there is no material 'ston'; did you mean 'stone'?"},
        {"DanglingShadow", light(directional + "[shadow.sum]\nresolution = 16"),
         "s.toml:8:1: there is no light 'sum'; did you mean 'sun'?"},
        {"TwoShadows", light(directional + "shadow = {resolution = 16}\n[shadow.sun]\nresolution = 16"),
         "s.toml:9:1: light 'sun' has its own 'shadow'; set light.sun.shadow instead"},
        {"BadId", scene("[[mesh]]\nid = \"a b\"\nshape = \"box\""),
         "s.toml:4:6: 'id' must be 1 to 64 letters, digits, '_' or '-'"},
        {"FlatScale", scene(box + "scale = [1, 0, 1]"), "s.toml:6:9: 'scale' must not be 0"},
        {"NoFile", scene("[[mesh]]\nid = \"a\""), "s.toml:3:1: [[mesh]] needs 'file'"},
        {"FatTorus", scene("[[mesh]]\nid = \"a\"\nshape = \"torus\"\ntube_radius_m = 2"),
         "s.toml:6:17: 'tube_radius_m' must be less than 'radius_m'"},
        {"ThinTorus", scene("[[mesh]]\nid = \"a\"\nshape = \"torus\"\nradius_m = 1e6\ntube_radius_m = 1"),
         "s.toml:7:17: 'tube_radius_m' must be at least 16 for such 'radius_m' and 'sides'"},
        {"NearlyFlatScale", scene(box + "scale = [1, 1e-30, 1]"),
         "s.toml:6:9: 'scale' must not be nearer to 0 than 1e-09"},
        {"TinySphere", scene("[[mesh]]\nid = \"a\"\nshape = \"sphere\"\nradius_m = 1e-50"),
         "s.toml:6:12: 'radius_m' must be in [1e-06, 1000000], not 1e-50"},
        {"TinyTop", scene("[[mesh]]\nid = \"a\"\nshape = \"cylinder\"\ntop_radius_m = 1e-50"),
         "s.toml:6:16: 'top_radius_m' must be 0 or at least 1e-06"},
        {"YearOfNoSolarModel",
         light("type = \"sun\"\nlatitude_deg = 0\nlongitude_deg = 0\ntime = 1799-12-31T23:59:59Z"),
         "s.toml:8:8: 'time' must be in the years 1800 to 2200, not 1799"},
        {"YearOfNoSolarModelInAKeyframe",
         light("type = \"sun\"\nlatitude_deg = 0\nlongitude_deg = 0\ntime = 2200-12-31T23:59:59Z\n"
               "[[frames.light]]\nid = \"sun\"\nframe = 1\ntime = 2201-01-01T00:00:00Z"),
         "s.toml:12:8: 'time' must be in the years 1800 to 2200, not 2201"},
        {"SecondTooFar",
         light("type = \"sun\"\nlatitude_deg = 0\nlongitude_deg = 0\ntime = 2016-12-31T23:59:61Z"),
         "s.toml:8:27: in time: expected second between 0 and 59 (inclusive), saw 61"},
        {"PathOverMidnight", sun_with("from = \"22:00\"\nto = \"04:00\""),
         "s.toml:10:6: 'to' (04:00) must be later than 'from' (22:00) on the same day; a path does not pass "
         "midnight, and 24:00 is the day's end"},
        {"PathOfNoLength", sun_with("to = 00:00:00"),
         "s.toml:9:6: 'to' (00:00:00) must be later than 'from' (00:00) on the same day; a path does not "
         "pass midnight, and 24:00 is the day's end"},
        {"PathFromTheDaysEnd", sun_with("from = \"24:00\""),
         "s.toml:9:8: 'to' (24:00) must be later than 'from' (24:00) on the same day; a path does not pass "
         "midnight, and 24:00 is the day's end"},
        {"PathFromNoTime", sun_with("from = \"6:30\""),
         "s.toml:9:8: 'from' must be \"HH:MM\" or \"HH:MM:SS\", 00:00 to 24:00, not \"6:30\""},
        {"PathBeyondTheDay", sun_with("to = \"24:01\""),
         "s.toml:9:6: 'to' must be \"HH:MM\" or \"HH:MM:SS\", 00:00 to 24:00, not \"24:01\""},
        {"PathFromANumber", sun_with("from = 6"), "s.toml:9:8: 'from' must be a time of day, not an integer"},
        {"PathFromAFraction", sun_with("from = 06:30:00.5"),
         "s.toml:9:8: 'from' must be \"HH:MM\" or \"HH:MM:SS\", 00:00 to 24:00, not \"06:30:00.500000000\""},
        {"NameThatIsATime", light(directional + "shadow.cache = 07:30:00"),
         "s.toml:8:16: 'cache' must be a string, not the time of day 07:30:00"},
        {"PathOfNoSteps", sun_with("steps = 0"), "s.toml:9:9: 'steps' must be in [1, 1440], not 0"},
        {"PathOfManySteps", sun_with("steps = 1441"), "s.toml:9:9: 'steps' must be in [1, 1440], not 1441"},
        {"PathOfAnotherLight", light(directional + "from = \"06:00\""),
         "s.toml:8:1: 'from' does not apply to [[light]] with type = \"directional\""},
        {"HoursOfNoSun", light(directional + "[[output]]\nfile = \"a.png\"\naov = \"sun_hours\""),
         "s.toml:10:7: 'aov' = \"sun_hours\" needs a light of type \"sun\""},
        {"EyeAtItsTarget", "format = 1\n[camera]\neye_m = [0, 0, 0]\nlook_at_m = [0, 0, -1e-40]\n",
         "s.toml:4:13: 'look_at_m' is nearer to 'eye_m' than 1e-06 m"},
        {"SpotAtItsTarget",
         light("type = \"spot\"\nposition_m = [0, 0, 0]\nlook_at_m = [0, 1e-200, 0]\nintensity_w_sr = 1"),
         "s.toml:7:13: 'look_at_m' is nearer to 'position_m' than 1e-06 m"},
        {"LocalTime",
         light("type = \"sun\"\nlatitude_deg = 0\nlongitude_deg = 0\ntime = 2026-06-21T12:00:00"),
         "s.toml:8:8: 'time' needs an offset from UTC, as in 2026-06-21T18:00:00+02:00"},
        {"ConesSwapped",
         light("type = \"spot\"\nposition_m = [0, 3, 0]\nlook_at_m = [0, 0, 0]\nintensity_w_sr = "
               "1\ninner_cone_deg = 40"),
         "s.toml:9:18: 'inner_cone_deg' must not be more than 'outer_cone_deg'"},
        {"OutputFormat", scene("[[output]]\nfile = \"a.jpg\""),
         "s.toml:4:8: 'file' must end in .png or .pfm"},
        {"OutputOutside", scene("[[output]]\nfile = \"../a.png\""),
         "s.toml:4:8: 'file' must stay inside the current folder"},
        {"OutputWithoutNumber", scene("[[output]]\nfile = \"a.png\"\n[frames]\nrange = \"1-2\""),
         "s.toml:4:8: 'file' needs #### for the frame number: there are 2 frames"},
        {"BadRange", scene("[frames]\nrange = \"5-1\""),
         "s.toml:4:9: 'range' must be like \"7\", \"1-48\" or \"1-48x2\""},
        {"KeyframeOfNoLight", scene("[[frames.light]]\nid = \"sun\"\nframe = 1"),
         "s.toml:4:6: there is no light 'sun'"},
        {"KeyframeOfOtherKind",
         light(directional + "[[frames.light]]\nid = \"sun\"\nframe = 1\nposition_m = [0, 0, 0]"),
         "s.toml:11:1: light 'sun' has no 'position_m'"},
        {"KeyframesFall", scene("[[frames.camera]]\nframe = 5\n[[frames.camera]]\nframe = 5"),
         "s.toml:6:9: keyframes of [camera] must rise: 5 follows 5"},
        {"CameraMeetsTarget",
         scene("[frames]\nrange = \"1-9\"\n[[frames.camera]]\nframe = 1\nlook_at_m = [-1, 1, 5]\n"
               "[[frames.camera]]\nframe = 9\nlook_at_m = [1, 1, 5]"),
         "s.toml:7:13: 'look_at_m' is the same point as 'eye_m'"},
    };
    return all;
}

void PrintTo(const BadScene& bad, std::ostream* out) {
    *out << bad.name;
}

class BadSceneTest : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneTest, IsRefusedWithThisMessage) {
    EXPECT_EQ(input_error(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BadSceneTest, testing::ValuesIn(bad_scenes()),
                         [](const auto& bad) { return std::string(bad.param.name); });

std::string repeated(const std::string& piece, int count) {
    std::string all;
    for (int i = 0; i < count; ++i)
        all += piece;
    return all;
}

TEST(SceneHints, NameTheNearestKeyThatIsNear) {
    EXPECT_EQ(nearest("vfov", {"eye_m", "vfov_deg"}), "vfov_deg") << "only the unit is missing";
    EXPECT_EQ(nearest("vf", {"eye_m", "vfov_deg"}), std::nullopt);
    EXPECT_EQ(nearest("vfv_de", {"eye_m", "vfov_deg", "vfov"}), "vfov_deg");
    EXPECT_EQ(nearest("ab", {"ba", "xy"}), "ba") << "swapped neighbours are one edit";
    EXPECT_EQ(nearest("ab", {"cd"}), std::nullopt);
    EXPECT_EQ(nearest(std::string(100000, 'a'), {std::string(64, 'a')}), std::nullopt);
}

// toml++ 3.3 overflows its stack on the first two.
TEST(ScenePrecheck, DepthsAreBounded) {
    const std::string deep_key = "s.toml:3:32: key has more than 16 parts";
    EXPECT_EQ(input_error(scene(repeated("a.", 200000) + "a = 1")), deep_key);
    EXPECT_EQ(input_error(scene("[" + repeated("a.", 200000) + "a]")),
              "s.toml:3:33: key has more than 16 parts");
    EXPECT_EQ(input_error(scene("\"a\"" + repeated(".'a'", 20) + " = 1")),
              "s.toml:3:64: key has more than 16 parts");
    const std::string nested = repeated("[", 65);
    EXPECT_EQ(input_error(scene("a = " + nested)), "s.toml:3:69: nested deeper than 64 levels");
    EXPECT_EQ(input_error(scene("a = " + repeated("{b=", 65))), "s.toml:3:197: nested deeper than 64 levels");
}

TEST(ScenePrecheck, DotsAndBracketsInStringsAndCommentsDoNotCount) {
    const std::string noise = repeated("[.", 100);
    EXPECT_EQ(input_error(scene("# " + noise + "\n[[output]]\nfile = \"" + noise + ".png\"")), "");
    EXPECT_EQ(input_error(scene("[[output]]\nfile = '''" + noise + "\".png'''")), "");
}

TEST(ScenePrecheck, SizesAreBounded) {
    EXPECT_EQ(input_error(scene("#" + std::string(1 << 20, 'x'))),
              "s.toml:3:1048577: line is longer than 1048576 bytes");
    EXPECT_EQ(input_error(std::string((16 << 20) + 1, '\n')),
              "s.toml: scene file has 16777217 bytes, more than 16777216");
}

TEST(SceneOverride, ErrorsNameTheOverride) {
    const std::string good =
        scene("[[light]]\nid = \"sun\"\ntype = \"directional\"\nazimuth_deg = 0\nelevation_deg = 9\n");
    const auto error = [&](const std::string& text) { return input_error(good, {text}); };
    EXPECT_EQ(error("camera.vfo_deg=3"),
              "-D camera.vfo_deg=3: unknown key 'vfo_deg' in [camera]; did you mean 'vfov_deg'?");
    EXPECT_EQ(error("camera.vfov_deg=300"),
              "-D camera.vfov_deg=300: 'vfov_deg' must be in [1e-06, 180), not 300");
    EXPECT_EQ(error("light.sum.azimuth_deg=3"),
              "-D light.sum.azimuth_deg=3: 'light' has no element 'sum'; did you mean 'sun'?");
    EXPECT_EQ(error("light.1.azimuth_deg=3"), "-D light.1.azimuth_deg=3: 'light' has no element '1'");
    EXPECT_EQ(error("light.sun=3"), "-D light.sun=3: say which key of 'sun' to set");
    EXPECT_EQ(error("format.a=3"), "-D format.a=3: 'format' is not a table");
    EXPECT_EQ(error("format"), "-D format: must be key=value");
    EXPECT_EQ(error("a..b=1"), "-D a..b=1: key has an empty part");
    EXPECT_EQ(error("camera.up=[0,1"), "-D camera.up=[0,1: in array: encountered end-of-file");
    EXPECT_EQ(error("camera.vfov_deg=45deg"),
              "-D camera.vfov_deg=45deg: in floating-point: expected decimal digit, saw 'd' (a value is a "
              "plain number: its unit stands in the key's name)");
    EXPECT_EQ(error("camera.vfov_deg=1\nformat=3"), "-D camera.vfov_deg=1\nformat=3: a value is one line");
}

TEST(SceneLimits, AreCheckedBeforeAnythingIsMade) {
    const auto limit_error = [](const std::string& text) -> std::string {
        try {
            read_scene_text(text, "s.toml");
        } catch (const LimitError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(limit_error(scene("[frames]\nrange = \"1-70000\"")),
              "s.toml: 70000 frames, more than limits.frames = 65536");
    EXPECT_EQ(limit_error(scene("[render]\nsize_px = [20000, 10]")),
              "s.toml: a frame of 20000 x 10 pixels is larger than limits.image_px = 16384");
    EXPECT_EQ(limit_error(scene("[[mesh]]\nid = \"a\"\nshape = \"sphere\"\nsegments = 4000\nrings = 4000\n"
                                "[limits]\ntriangles = 1000000")),
              "s.toml: shapes of up to 32000000 triangles, more than limits.triangles = 1000000");
}

}  // namespace
}  // namespace obscura
