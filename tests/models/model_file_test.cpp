#include "app/models/model_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "app/models/obj_file.h"
#include "core/error.h"
#include "tests/core/shared_folder.h"
#include "tests/core/temporary_folder.h"
#include "tests/models/model_bytes.h"

namespace obscura {
namespace {

class ModelFile : public ::testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) {
        std::ofstream(folder.path / name, std::ios::binary) << bytes;
        return folder.path / name;
    }
    Model load(const std::filesystem::path& file) {
        return load_model(file, FileAccess{folder.path, {}}, Limits{});
    }
    TemporaryFolder folder;
};

TEST_F(ModelFile, KindsAreToldByEndingsThenByContent) {
    const std::string ply = ply_of(cube(), PlyKind::little), stl = text_stl_of(cube(), "c"),
                      obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_EQ(load(write("a.PLY", ply)).mesh.triangles.size(), 12u);
    EXPECT_EQ(load(write("a.Stl", stl)).mesh.triangles.size(), 12u);
    EXPECT_EQ(load(write("a.obj", obj)).mesh.triangles.size(), 1u);
    EXPECT_EQ(load(write("b", ply)).mesh.triangles.size(), 12u);
    EXPECT_EQ(load(write("c.txt", stl)).mesh.triangles.size(), 12u);
    EXPECT_EQ(load(write("d.mesh", obj)).mesh.triangles.size(), 1u);
    EXPECT_THROW(load(write("e.ply", obj)), InputError);
}

TEST_F(ModelFile, PipesAreNotWaitedFor) {
    for (const char* name : {"pipe", "pipe.ply", "pipe.stl", "pipe.glb"}) {
        ASSERT_EQ(::mkfifo((folder.path / name).c_str(), 0600), 0);
        EXPECT_THROW(load(folder.path / name), InputError) << name;
    }
}

TEST_F(ModelFile, OtherKindsAreNamed) {
    try {
        load(write("a.FBX", "Kaydara"));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.message, ".fbx files are not read; OBJ, glTF, PLY and STL are");
    }
}

std::vector<Vec3f> normals_of(const Mesh& mesh) {
    std::vector<Vec3f> normals;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t.v)
            normals.push_back(mesh.normals[v]);
    return normals;
}

/// A published scan written as every other kind has the same triangles and topology.
TEST_F(ModelFile, RealMeshesAreTheSameInEveryFormat) {
    const std::filesystem::path file = shared_folder("data/meshes/fandisk.obj");
    SKIP_WITHOUT(file);
    const Model obj = load_obj(file, FileAccess{file.parent_path(), {}}, Limits{});
    const Mesh& mesh = obj.mesh;
    for (const auto& [name, bytes] :
         {std::pair{"a.ply", ply_of(mesh, PlyKind::ascii)}, std::pair{"l.ply", ply_of(mesh, PlyKind::little)},
          std::pair{"b.ply", ply_of(mesh, PlyKind::big)}, std::pair{"b.stl", binary_stl_of(mesh)},
          std::pair{"t.stl", text_stl_of(mesh, "t")}}) {
        const Model other = load(write(name, bytes));
        EXPECT_EQ(corners_of(other.mesh), corners_of(mesh)) << name;
        EXPECT_EQ(normals_of(other.mesh), normals_of(mesh)) << name;
        EXPECT_EQ(other.topology.welded.open, obj.topology.welded.open) << name;
        EXPECT_EQ(other.topology.welded.multi, obj.topology.welded.multi) << name;
    }
}

}  // namespace
}  // namespace obscura
