// Bad OBJ and MTL input: each case with the kind of error and the message that the user reads.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <ostream>

#include "app/models/obj_file.h"
#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

constexpr const char* triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

struct BadText {
    const char* name;
    std::string obj, mtl, message;
};

std::ostream& operator<<(std::ostream& out, const BadText& bad) {
    return out << bad.name;
}

std::vector<BadText> bad_texts() {
    const std::string t = triangle, lib = "mtllib a.mtl\n" + t + "usemtl m\nf 1 2 3\n";
    std::string many = "v 0 0 0\nf";
    for (int i = 0; i <= 10'000; ++i)
        many += " 1";
    return {
        {"index_beyond", t + "f 1 2 4\n", "", "text.obj:4: position index 4 is out of range, the file has 3"},
        {"relative_index_before", t + "f -9 -8 -7\n", "",
         "text.obj:4: '-9': index -9 is out of range, there are 3"},
        {"relative_index_by_one", t + "f 1 2 -4\n", "", "text.obj:4: '-4': index -4 is out of range"},
        {"index_wraps_32_bits", t + "f 1 2 4294967297\n", "", "text.obj:4: '4294967297': index 4294967297"},
        {"index_11_digits", t + "f 1 2 99999999999\n", "",
         "text.obj:4: '99999999999': index 99999999999 is out"},
        {"index_wraps_64_bits", t + "f 1 2 99999999999999999999\n", "",
         "index 99999999999999999999 is out of range"},
        {"index_zero", t + "f 0 1 2\n", "", "text.obj:4: '0': index 0; OBJ counts from 1"},
        {"index_word", t + "f 1 2 x\n", "", "text.obj:4: 'x' is not a face corner"},
        {"index_fraction", t + "f 1 2 3.0\n", "", "'3.0' is not a face corner"},
        {"corner_half_open", t + "f /1 2 3\n", "", "'/1' is not a face corner"},
        {"corner_three_slashes", t + "f 1/// 2 3\n", "", "'1///' is not a face corner"},
        {"comment_does_not_join", t + "f 1 2 # C:\\\n3\n", "", "text.obj:4: a face needs 3 corners"},
        {"material_of_two_comments", lib, "newmtl m # a\nnewmtl m # b\n",
         "text.obj:5: material 'm' may be 'm # a' or 'm # b'"},
        {"corner_four_parts", t + "vt 0 0\nvn 0 0 1\nf 1/1/1/1 2 3\n", "", "'1/1/1/1' is not a face corner"},
        {"uv_index_beyond", t + "vt 0 0\nf 1/1 2/2 3/1\n", "",
         "text.obj:5: texture index 2 is out of range, the file has 1"},
        {"normal_index_beyond", t + "f 1//1 2//1 3//1\n", "",
         "text.obj:4: normal index 1 is out of range, the file has 0"},
        {"uv_relative_before", t + "vt 0 0\nf 1/-2 2 3\n", "", "index -2 is out of range, there are 1"},
        {"line_counts_crlf_and_joints", "v 0 0 0\r\nv 1 \\\r\n0 0\r\nv 0 1 0\r\nf 1 2 9\r\n", "",
         "text.obj:5: position"},
        {"words_for_numbers", "v a b c\n", "", "text.obj:1: 'a' is not a number"},
        {"decimal_comma", "v 0,5 0 0\n", "",
         "text.obj:1: '0,5' is not a number (decimals are written with a point)"},
        {"trailing_letters", "v 1.5m 0 0\n", "", "'1.5m' is not a number"},
        {"hexadecimal", "v 0x10 0 0\n", "", "'0x10' is not a number"},
        {"not_a_number", "v nan 0 0\n", "", "text.obj:1: 'nan' is not a finite number"},
        {"infinity", "v 0 -inf 0\n", "", "'-inf' is not a finite number"},
        {"beyond_double", "v 1e400 0 0\n", "", "'1e400' is not a finite number"},
        {"beyond_float", "v 0 1e39 0\n", "", "'1e39' is not a finite number in single precision"},
        {"two_coordinates", "v 1 2\n", "", "text.obj:1: v takes 3 numbers"},
        {"no_coordinates", "v\n", "", "found 0"},
        {"short_normal", "vn 1 2\n", "", "text.obj:1: vn takes 3 numbers, found 2"},
        {"empty_vt", "vt\n", "", "vt takes 1 to 3 numbers, found 0"},
        {"two_corners", t + "f 1 2\n", "", "text.obj:4: a face needs 3 corners or more, found 2"},
        {"no_corners", t + "f\n", "", "a face needs 3 corners or more, found 0"},
        {"giant_polygon", many, "", "text.obj:2: a face of more than 10000 corners"},
        {"truncated_face", t + "f 1 2", "", "text.obj:4: a face needs 3 corners"},
        {"truncated_number", t + "v 1 2 3e", "", "text.obj:4: '3e' is not a number"},
        {"unknown_keyword", t + "vertex 1 2 3\n", "", "text.obj:4: unknown keyword 'vertex'"},
        {"binary", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), "",
         "text.obj:1: unknown keyword '\x89PNG'"},
        {"nul_byte", std::string("v 1 2\0 3\n", 9), "", "'2?' is not a number"},
        {"free_form_surface", t + "surf 0 1 0 1 1 2 3\n", "",
         "free-form curves and surfaces are not supported"},
        {"smoothing_word", "s maybe\n", "", "text.obj:1: s takes a group number or off, found 'maybe'"},
        {"unknown_material", "mtllib a.mtl\n" + t + "usemtl n\nf 1 2 3\n", "newmtl m\n",
         "text.obj:5: material 'n' is not defined in any mtllib (--allow-missing"},
        {"mtl_before_newmtl", lib, "Kd 1 1 1\nnewmtl m\n", "text.mtl:1: Kd before any newmtl"},
        {"mtl_word", lib, "newmtl m\nKd red\n", "text.mtl:2: 'red' is not a number"},
        {"mtl_two_numbers", lib, "newmtl m\nKs 1 2\n", "text.mtl:2: Ks takes 3 numbers, found 2"},
        {"mtl_negative", lib, "newmtl m\nKe 0 -1 0\n", "text.mtl:2: Ke must not be negative"},
        {"mtl_spectral", lib, "newmtl m\nKd spectral a.rfl\n", "text.mtl:2: Kd spectral is not supported"},
        {"mtl_exponent", lib, "newmtl m\nNs -5\n", "text.mtl:2: Ns must be in [0, 1000000], not -5"},
        {"mtl_roughness", lib, "newmtl m\nPr 1.5\n", "text.mtl:2: Pr must be in [0, 1]"},
        {"mtl_nan", lib, "newmtl m\nNs nan\n", "text.mtl:2: 'nan' is not a finite number"},
        {"mtl_no_name", lib, "newmtl\n", "text.mtl:1: newmtl without a name"},
        {"texture_no_name", lib, "newmtl m\nmap_Kd\n", "text.mtl:2: map_Kd names no file"},
        {"texture_scaled", lib, "newmtl m\nmap_Kd -s 2 2 2 a.png\n",
         "scaling, moving, clamping or recolouring"},
    };
}

class ObjErrors : public testing::TestWithParam<BadText> {};

TEST_P(ObjErrors, SayWhereAndWhat) {
    const BadText& bad = GetParam();
    try {
        obj_from_text(bad.obj, bad.mtl, Limits{});
        FAIL() << "accepted; wanted: " << bad.message;
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(bad.message), std::string::npos) << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Texts, ObjErrors, testing::ValuesIn(bad_texts()),
                         [](const auto& text) { return text.param.name; });

/// Cases that need a disk.
class ObjFileErrors : public testing::Test {
  protected:
    template <class Error>
    void expect_error(const std::filesystem::path& file, const std::string& part, const Limits& limits = {}) {
        try {
            load_obj(file, FileAccess{folder.path / "scene", {}}, limits);
            ADD_FAILURE() << "accepted; wanted: " << part;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    }
    std::filesystem::path obj(const std::string& head) {
        return folder.write("scene/m.obj", head + "\n" + triangle + "usemtl a\nf 1 2 3\n");
    }

    TemporaryFolder folder;
};

TEST_F(ObjFileErrors, Materials) {
    folder.write("outside.mtl", "newmtl a\n");
    expect_error<InputError>(obj("mtllib ../outside.mtl"), "m.obj:1: mtllib ../outside.mtl: leads outside");
    expect_error<InputError>(obj("mtllib /etc/passwd"), "m.obj:1: mtllib /etc/passwd: leads outside");
    std::filesystem::create_symlink("../outside.mtl", folder.path / "scene/link.mtl");
    expect_error<InputError>(obj("mtllib link.mtl"), "m.obj:1: mtllib link.mtl: leads outside");
    expect_error<InputError>(obj("mtllib none.mtl"),
                             "m.obj:1: mtllib none.mtl: cannot open: No such file or "
                             "directory (--allow-missing");
    expect_error<InputError>(obj("mtllib"), "m.obj:1: mtllib : empty file name");
    expect_error<InputError>(obj("mtllib ."), "scene: not a regular file, but a folder");
    folder.write("scene/bad.mtl", "newmtl a\n\nKd x\n");
    expect_error<InputError>(obj("mtllib bad.mtl"), "bad.mtl:3: 'x' is not a number");
    ASSERT_EQ(::mkfifo((folder.path / "scene/fifo.mtl").c_str(), 0600), 0);
    expect_error<InputError>(obj("mtllib fifo.mtl"), "fifo.mtl: not a regular file, but a FIFO");
}

TEST_F(ObjFileErrors, Textures) {
    folder.write("secret.png", "");
    folder.write("scene/t.mtl", "newmtl a\nmap_Kd ../secret.png\n");
    expect_error<InputError>(obj("mtllib t.mtl"), "t.mtl:2: map_Kd ../secret.png: leads outside");
    folder.write("scene/t.mtl", "newmtl a\nKd 1 1 1\nmap_Kd none.png\n");
    expect_error<InputError>(obj("mtllib t.mtl"), "t.mtl:3: map_Kd none.png: cannot open: No such file");
    std::filesystem::create_symlink("../secret.png", folder.path / "scene/link.png");
    folder.write("scene/t.mtl", "newmtl a\nmap_Kd link.png\n");
    expect_error<InputError>(obj("mtllib t.mtl"), "t.mtl:2: map_Kd link.png: leads outside");
}

TEST_F(ObjFileErrors, ThingsThatAreNotFiles) {
    expect_error<InputError>(folder.path / "scene/none.obj",
                             "none.obj: cannot open: No such file or directory");
    std::filesystem::create_directory(folder.path / "scene");
    expect_error<InputError>(folder.path / "scene", "scene: not a regular file, but a folder");
    expect_error<InputError>("/dev/zero", "/dev/zero: not a regular file, but a device");
    ASSERT_EQ(::mkfifo((folder.path / "scene/fifo.obj").c_str(), 0600), 0);
    expect_error<InputError>(folder.path / "scene/fifo.obj", "fifo.obj: not a regular file, but a FIFO");
}

TEST_F(ObjFileErrors, Limits) {
    const auto file = folder.write("scene/m.obj", std::string(triangle) + "f 1 2 3\nf 1 2 3 1 2\n");
    obscura::Limits limits;
    limits.triangles = 4;
    EXPECT_EQ(load_obj(file, FileAccess{folder.path, {}}, limits).mesh.triangles.size(), 4u);
    limits.triangles = 3;
    expect_error<LimitError>(file, "m.obj:5: more than 3 triangles (limits.triangles)", limits);
    limits.triangles = 0;
    expect_error<LimitError>(file, "m.obj:1: more than 0 positions", limits);
    limits = {};
    limits.memory_mib = 1;
    const auto large = folder.write("scene/large.obj", std::string(200'000, '\n'));
    expect_error<LimitError>(large,
                             "large.obj: 200000 bytes or more, the limit for this file is 131072 bytes, an "
                             "eighth of limits.memory_mib",
                             limits);
}

}  // namespace
}  // namespace obscura
