// llvmpipe, used the way an application without a GPU uses it: one vertex and index buffer, OpenGL 3.3 core,
// 32-bit float depth textures. Depth peeling after Everitt, "Interactive order-independent transparency",
// 2001.

#include "bench/raster/peer_llvmpipe.h"

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

#include "bench/harness/run_times.h"
#include "bench/raster/gl_api.h"
#include "bench/raster/phong_scene.h"
#include "bench/raster/views.h"

namespace obscura {
namespace {

constexpr const char* depth_vertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_world;
void main() { gl_Position = clip_from_world * vec4(position, 1.0); }
)";

constexpr const char* depth_fragment = R"(#version 330 core
void main() {}
)";

constexpr const char* peel_fragment = R"(#version 330 core
uniform sampler2D first;
void main() {
    if (gl_FragCoord.z <= texelFetch(first, ivec2(gl_FragCoord.xy), 0).r) discard;
}
)";

constexpr const char* frame_vertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 clip_from_world;
uniform mat4 map_from_world;   // texture coordinates and depth of the shadow map
uniform float offset_m;
out vec3 world, world_normal, map_position;
void main() {
    world = position;
    world_normal = normal;
    map_position = (map_from_world * vec4(position + offset_m * normal, 1.0)).xyz;
    gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

// The same Phong terms as phong_kernel.cpp.
constexpr const char* frame_fragment = R"(#version 330 core
in vec3 world, world_normal, map_position;
uniform sampler2DShadow shadow_map;
uniform vec3 eye, to_light, albedo, sun, ambient;
uniform float specular;
out vec4 color;
void main() {
    vec3 n = normalize(world_normal);
    float n_dot_l = max(dot(n, to_light), 0.0);
    vec3 r = 2.0 * n_dot_l * n - to_light;
    float shine = max(dot(r, normalize(eye - world)), 0.0);
    shine *= shine; shine *= shine; shine *= shine; shine *= shine; shine *= shine;
    float lit = texture(shadow_map, map_position);
    vec3 light = albedo * (ambient + sun * (lit * n_dot_l));
    if (n_dot_l > 0.0) light += sun * (lit * specular * shine);
    color = vec4(light, 1.0);
}
)";

enum class Cull { none, back, front };

/// A texture of `size` and the framebuffer that draws into it.
struct Target {
    GLuint texture = 0, framebuffer = 0;
    int width = 0, height = 0;
};

struct LlvmpipeState {
    GlContext context;
    const BenchScene* bench = nullptr;
    GLuint vertex_array = 0;
    GLsizei indices = 0;
    Target first, second, frame;
    GLuint compare_sampler = 0;
    GLuint depth_program = 0, peel_program = 0, frame_program = 0;
};

GLuint compile(const GlApi& gl, GLenum kind, const char* source) {
    const GLuint shader = gl.CreateShader(kind);
    gl.ShaderSource(shader, 1, &source, nullptr);
    gl.CompileShader(shader);
    GLint ok = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    char log[1024] = "";
    if (ok == 0) gl.GetShaderInfoLog(shader, sizeof log, nullptr, log);
    if (ok == 0) throw std::runtime_error(fmt::format("GLSL: {}", log));
    return shader;
}

GLuint link(const GlApi& gl, const char* vertex, const char* fragment) {
    const GLuint program = gl.CreateProgram();
    gl.AttachShader(program, compile(gl, GL_VERTEX_SHADER, vertex));
    gl.AttachShader(program, compile(gl, GL_FRAGMENT_SHADER, fragment));
    gl.LinkProgram(program);
    GLint ok = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &ok);
    char log[1024] = "";
    if (ok == 0) gl.GetProgramInfoLog(program, sizeof log, nullptr, log);
    if (ok == 0) throw std::runtime_error(fmt::format("GLSL: {}", log));
    return program;
}

GLuint make_texture(const GlApi& gl, GLint format, int width, int height, GLenum layout, GLenum type) {
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, layout, type, nullptr);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

void check_complete(const GlApi& gl) {
    const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error(fmt::format("framebuffer status {:#x}", status));
}

Target make_depth_target(const GlApi& gl, int width, int height) {
    Target target{0, 0, width, height};
    target.texture = make_texture(gl, GL_DEPTH_COMPONENT32F, width, height, GL_DEPTH_COMPONENT, GL_FLOAT);
    gl.GenFramebuffers(1, &target.framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, target.texture, 0);
    gl.DrawBuffer(GL_NONE);
    gl.ReadBuffer(GL_NONE);
    check_complete(gl);
    return target;
}

Target make_frame_target(const GlApi& gl, int width, int height) {
    Target target{0, 0, width, height};
    target.texture = make_texture(gl, GL_RGBA8, width, height, GL_RGBA, GL_UNSIGNED_BYTE);
    const GLuint depth = make_texture(gl, GL_DEPTH_COMPONENT32F, width, height, GL_DEPTH_COMPONENT, GL_FLOAT);
    gl.GenFramebuffers(1, &target.framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.texture, 0);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    check_complete(gl);
    return target;
}

GLuint make_compare_sampler(const GlApi& gl) {
    GLuint sampler = 0;
    gl.GenSamplers(1, &sampler);
    gl.SamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.SamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.SamplerParameteri(sampler, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.SamplerParameteri(sampler, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl.SamplerParameteri(sampler, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl.SamplerParameteri(sampler, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    return sampler;
}

void upload_mesh(LlvmpipeState& state, const Mesh& mesh) {
    const GlApi& gl = state.context.gl;
    gl.GenVertexArrays(1, &state.vertex_array);
    gl.BindVertexArray(state.vertex_array);
    GLuint buffers[3] = {};
    gl.GenBuffers(3, buffers);
    const auto fill = [&](GLenum target, GLuint buffer, const auto& values) {
        gl.BindBuffer(target, buffer);
        gl.BufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof values[0]), values.data(),
                      GL_STATIC_DRAW);
    };
    fill(GL_ARRAY_BUFFER, buffers[0], mesh.positions);
    gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(0);
    fill(GL_ARRAY_BUFFER, buffers[1], mesh.normals);
    gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(1);
    fill(GL_ELEMENT_ARRAY_BUFFER, buffers[2], mesh.triangles);
    state.indices = static_cast<GLsizei>(3 * mesh.triangles.size());
    gl.Finish();
}

/// Sets a mat4 uniform; OpenGL takes our row-major matrix transposed.
void set_matrix(const GlApi& gl, GLuint program, const char* name, const Mat4& matrix) {
    float values[16];
    for (int i = 0; i < 16; ++i)
        values[i] = static_cast<float>(matrix.m[i / 4][i % 4]);
    gl.UniformMatrix4fv(gl.GetUniformLocation(program, name), 1, GL_TRUE, values);
}

void set_frame_uniforms(LlvmpipeState& state) {
    const GlApi& gl = state.context.gl;
    const BenchScene& bench = *state.bench;
    const GLuint program = state.frame_program;
    gl.UseProgram(program);

    // Near and far planes of the camera around the scene; map texels to texture coordinates.
    const double far_m = view_distance_m(bench);
    const RenderSettings& render = bench.scene.render;
    const Mat4 camera = clip_from_world(bench.scene.camera, render.width, render.height, far_m / 1000, far_m);
    const Mat4 texture_from_map{{{1.0 / bench.light.width, 0, 0, 0},
                                 {0, 1.0 / bench.light.height, 0, 0},
                                 {0, 0, 1, 0},
                                 {0, 0, 0, 1}}};
    set_matrix(gl, program, "clip_from_world", camera);
    set_matrix(gl, program, "map_from_world", texture_from_map * bench.light.to_map);

    const PhongScene phong = phong_constants(bench);
    const auto set3 = [&](const char* name, const float* v) {
        gl.Uniform3fv(gl.GetUniformLocation(program, name), 1, v);
    };
    set3("eye", phong.eye);
    set3("to_light", phong.to_light);
    set3("albedo", phong.albedo);
    set3("sun", phong.sun);
    set3("ambient", phong.ambient);
    gl.Uniform1f(gl.GetUniformLocation(program, "specular"), phong.specular);
    gl.Uniform1f(gl.GetUniformLocation(program, "offset_m"), phong.offset_m);
    gl.Uniform1i(gl.GetUniformLocation(program, "shadow_map"), 0);
}

void set_cull(const GlApi& gl, Cull cull) {
    if (cull == Cull::none) {
        gl.Disable(GL_CULL_FACE);
        return;
    }
    gl.Enable(GL_CULL_FACE);
    gl.CullFace(cull == Cull::back ? GL_BACK : GL_FRONT);
}

/// Clears a target and draws the mesh into it; the caller has bound the program and its textures.
void draw(const LlvmpipeState& state, const Target& target, Cull cull, GLbitfield clear) {
    const GlApi& gl = state.context.gl;
    gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl.Viewport(0, 0, target.width, target.height);
    gl.Clear(clear);
    set_cull(gl, cull);
    gl.DrawElements(GL_TRIANGLES, state.indices, GL_UNSIGNED_INT, nullptr);
}

void draw_depth(const LlvmpipeState& state, const Target& target, Cull cull) {
    state.context.gl.UseProgram(state.depth_program);
    draw(state, target, cull, GL_DEPTH_BUFFER_BIT);
}

void draw_peel(const LlvmpipeState& state) {
    const GlApi& gl = state.context.gl;
    draw_depth(state, state.first, Cull::none);
    gl.UseProgram(state.peel_program);
    gl.BindTexture(GL_TEXTURE_2D, state.first.texture);
    draw(state, state.second, Cull::none, GL_DEPTH_BUFFER_BIT);
}

// Looks shadows up in `first`: every job leaves some map of the light's nearest depths there.
void draw_frame(const LlvmpipeState& state) {
    const GlApi& gl = state.context.gl;
    gl.UseProgram(state.frame_program);
    gl.BindTexture(GL_TEXTURE_2D, state.first.texture);
    gl.BindSampler(0, state.compare_sampler);
    draw(state, state.frame, Cull::back, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl.BindSampler(0, 0);
}

void read_depth(const LlvmpipeState& state, const Target& target, float* result) {
    const GlApi& gl = state.context.gl;
    gl.BindTexture(GL_TEXTURE_2D, target.texture);
    gl.GetTexImage(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT, GL_FLOAT, result);
}

void read_frame(const LlvmpipeState& state, float* result) {
    const GlApi& gl = state.context.gl;
    gl.BindTexture(GL_TEXTURE_2D, state.frame.texture);
    gl.GetTexImage(GL_TEXTURE_2D, 0, GL_RGB, GL_FLOAT, result);
}

std::vector<Job> jobs_of(const LlvmpipeState& s) {
    // A job is over when OpenGL has finished, not when it has been told.
    const auto timed = [&s](auto fn) {
        return [&s, fn] {
            fn(s);
            s.context.gl.Finish();
        };
    };
    using State = LlvmpipeState;
    const auto read_one = [&s](float* r) { read_depth(s, s.first, r); };
    const auto read_both = [&s](float* r) {
        read_depth(s, s.first, r);
        read_depth(s, s.second, r + static_cast<std::ptrdiff_t>(s.first.width) * s.first.height);
    };
    const auto read_color = [&s](float* r) { read_frame(s, r); };
    return {
        {Workload::depth, "all faces", true,
         timed([](const State& t) { draw_depth(t, t.first, Cull::none); }), read_one},
        {Workload::depth, "back faces culled", true,
         timed([](const State& t) { draw_depth(t, t.first, Cull::back); }), read_one},
        {Workload::dual_depth, "two-pass depth peel", true, timed(draw_peel), read_both},
        {Workload::dual_depth, "nearest front + nearest back", false, timed([](const State& t) {
             draw_depth(t, t.first, Cull::back);
             draw_depth(t, t.second, Cull::front);
         }),
         read_both},
        {Workload::frame, "Phong + map, 1 tap", true, timed([](const State& t) {
             draw_depth(t, t.first, Cull::back);
             draw_frame(t);
         }),
         read_color},
        {Workload::static_frame, "Phong, 1 tap, map kept", true, timed(draw_frame), read_color},
    };
}

Session open_llvmpipe(const BenchScene& bench, const Exec& exec) {
    // 0 = rasterize on the application's own thread. With more, that thread still does vertices and binning.
    setenv("LP_NUM_THREADS", exec.threads == 1 ? "0" : std::to_string(exec.threads).c_str(), 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    const auto state = std::make_shared<LlvmpipeState>();
    state->bench = &bench;
    open_gl(state->context);
    const GlApi& gl = state->context.gl;

    const double upload_ms = milliseconds_of([&] { upload_mesh(*state, bench.scene.mesh); });

    state->depth_program = link(gl, depth_vertex, depth_fragment);
    state->peel_program = link(gl, depth_vertex, peel_fragment);
    state->frame_program = link(gl, frame_vertex, frame_fragment);
    const Mat4 light_clip = clip_from_world(bench.light);
    for (const GLuint program : {state->depth_program, state->peel_program}) {
        gl.UseProgram(program);
        set_matrix(gl, program, "clip_from_world", light_clip);
    }
    set_frame_uniforms(*state);
    state->first = make_depth_target(gl, bench.light.width, bench.light.height);
    state->second = make_depth_target(gl, bench.light.width, bench.light.height);
    state->frame = make_frame_target(gl, bench.scene.render.width, bench.scene.render.height);
    state->compare_sampler = make_compare_sampler(gl);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_LESS);
    gl.FrontFace(GL_CW);  // see clip_from_world
    gl.ClearColor(0, 0, 0, 0);
    if (const GLenum error = gl.GetError(); error != GL_NO_ERROR) {
        throw std::runtime_error(fmt::format("OpenGL error {:#x} while preparing", error));
    }

    const auto text = [&](GLenum name) { return reinterpret_cast<const char*>(gl.GetString(name)); };
    Session session;
    session.version = fmt::format("{}, OpenGL {}", text(GL_RENDERER), text(GL_VERSION));
    session.prepare_ms = upload_ms;
    session.jobs = jobs_of(*state);
    session.state = state;
    return session;
}

}  // namespace

Contestant llvmpipe_contestant() {
    return {"llvmpipe", "", open_llvmpipe};
}

}  // namespace obscura
