#pragma once
// Tries values for keys of a scene and sees whether the scene changes: a key that nobody reads is found out.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "app/models/file_access.h"
#include "app/scene/scene_file.h"
#include "app/scene/schema.h"
#include "app/scene/toml_text.h"
#include "core/error.h"
#include "core/image_io.h"

namespace obscura {

/// Values to try for a key, in TOML: whatever its type allows.
inline std::vector<std::string> candidates(const KeySpec& key) {
    static const std::map<std::string, std::vector<std::string>> special = {
        {"file", {"\"other.obj\"", "\"other_####.png\"", "\"other.pgm\"", "\"other.pfm\""}},
        {"mask", {"\"other.pgm\""}},
        {"texture", {"\"other.png\""}},
        {"cache", {"\"maps\""}},
        {"material", {"\"other\"", "\"main\""}},
        {"materials", {"{default = \"other\"}"}},
        {"range", {"\"2-6\""}},
        {"id", {"\"renamed\"", "\"second\""}},
        {"sun", {"\"second\""}},
        {"time", {"2026-06-21T10:00:00Z", "2026-06-21T12:00:00Z"}},
        {"frame", {"2.5"}},
    };
    const auto it = special.find(key.name);
    if (it != special.end() && key.type != KeyType::name_list) return it->second;
    std::vector<std::string> values;
    const auto add = [&](double v) {
        if (key.range.contains(v)) values.push_back(toml_text(value_of(v)));
    };
    switch (key.type) {
        case KeyType::boolean:
            return {"true", "false"};
        case KeyType::choice:
            for (const std::string& c : key.choices)
                values.push_back("\"" + c + "\"");
            return values;
        case KeyType::integer:
            for (const std::int64_t v : key.allowed)
                values.push_back(std::to_string(v));
            for (const std::int64_t v : {3, 5, 8, 2, 1500}) {
                if (key.allowed.empty() && key.range.contains(static_cast<double>(v)))
                    values.push_back(std::to_string(v));
            }
            return values;
        case KeyType::time_of_day:
            return {"\"07:30\"", "\"18:00:30\""};
        case KeyType::size2:
            return {"[32, 16]"};
        case KeyType::vec2:
            return {"[3.5, 4.25]"};
        case KeyType::name_list:
            return {"[\"m\"]", "[\"other\"]"};
        case KeyType::vec3:
        case KeyType::vec3_or_number:
            return {"[0.25, 0.5, 0.75]", "[0.5, 3, 1.25]", "[1, 0, 0.5]", "[0.75, 1, 0.25]"};
        default:
            for (const double v : {0.3, 0.07, 0.02, 1.5, 4.0, 11.0, 37.0, 70.0, 120.0, 3000.0, -0.3})
                add(v);
            return values;
    }
}

/// The required ones of `keys`, each with a value; neighbours in the list have different ones.
inline std::string required_keys(const std::vector<KeySpec>& keys) {
    std::string text;
    std::size_t n = 0;
    for (const KeySpec& key : keys) {
        if (!key.required) continue;
        const std::vector<std::string> values = candidates(key);
        text += key.name + " = " + values.at(n++ % values.size()) + "\n";
    }
    return text;
}

/// A folder with files that scenes can name, and the question whether a key changes what they come to.
template <class Look>
class SceneKeyProbe : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "obscura_keys_XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        access_.root = name;
        write("tent.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 1\nv 1 2 0\nv 0 2 0\nf 1 2 3 4\nf 4 3 5 6\n");
        write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        write("one.pgm", "P2 2 1 3 1 3");
        write("other.pgm", "P2 2 1 3 3 2");
        write("one.pfm", encode_pfm(Image<Vec3f>(4, 2, Vec3f{1, 2, 3}).view()));
        write("other.pfm", encode_pfm(Image<Vec3f>(4, 2, Vec3f{3, 2, 1}).view()));
        write("one.png", encode_png(Image<Rgb8>(2, 2, Rgb8{10, 20, 30}).view()));
        write("other.png", encode_png(Image<Rgb8>(2, 2, Rgb8{40, 20, 30}).view()));
    }
    void TearDown() override { std::filesystem::remove_all(access_.root); }
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(access_.root / name, std::ios::binary) << bytes;
    }

    /// Everything that the scene comes to as far as the keys under test go.
    virtual Look look_of(const SceneDocument& document) const = 0;

    /// True when some value of `key` under `prefix` gives another scene than `base`.
    bool matters(const std::string& base, const std::string& prefix, const KeySpec& key) const {
        const Look before = look_of(read_scene_text(base, "base.toml"));
        for (const std::string& value : candidates(key)) {
            try {
                const SceneDocument changed =
                    read_scene_text(base, "base.toml", {prefix + key.name + "=" + value});
                if (!(look_of(changed) == before)) return true;
            } catch (const InputError&) {
                // Not every candidate fits: another one may.
            } catch (const LimitError&) {
            }
        }
        return false;
    }

    void expect_all_matter(const std::vector<std::string>& bases, const std::string& prefix,
                           const std::vector<KeySpec>& keys, const std::set<std::string>& except = {}) {
        for (const KeySpec& key : keys) {
            if (key.table != nullptr || except.count(key.name) != 0) continue;
            const bool any = std::any_of(bases.begin(), bases.end(),
                                         [&](const std::string& base) { return matters(base, prefix, key); });
            EXPECT_TRUE(any) << prefix << key.name << " changes nothing";
        }
    }

    FileAccess access_;
};

}  // namespace obscura
