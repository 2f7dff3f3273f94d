#pragma once
// OpenGL 3.3 core without a window: functions and a context from OSMesa. The library is loaded when a bench
// asks for it, not linked: it drags in all of LLVM, which no other command should wait for. (Included by
// peer_llvmpipe.cpp only.)

#define GL_GLEXT_PROTOTYPES 1
#include <GL/osmesa.h>

#include <array>

namespace obscura {

/// Every OpenGL function the peer calls.
// clang-format off
#define OBSCURA_GL_FUNCTIONS(X)                                                                     \
    X(AttachShader) X(BindBuffer) X(BindFramebuffer) X(BindSampler) X(BindTexture)                  \
    X(BindVertexArray) X(ActiveTexture) X(BufferData) X(CheckFramebufferStatus) X(Clear)            \
    X(ClearColor) X(ColorMask) X(CompileShader) X(CreateProgram) X(CreateShader) X(CullFace)        \
    X(DepthFunc) X(Disable) X(DrawBuffer) X(DrawElements) X(Enable) X(EnableVertexAttribArray)      \
    X(Finish) X(FramebufferTexture2D) X(FrontFace) X(GenBuffers) X(GenFramebuffers) X(GenSamplers)  \
    X(GenTextures) X(GenVertexArrays) X(GetError) X(GetProgramInfoLog) X(GetProgramiv)              \
    X(GetShaderInfoLog) X(GetShaderiv) X(GetString) X(GetTexImage) X(GetUniformLocation)            \
    X(LinkProgram) X(PixelStorei) X(ReadBuffer) X(SamplerParameteri) X(ShaderSource) X(TexImage2D)  \
    X(TexParameteri) X(Uniform1f) X(Uniform1i) X(Uniform3fv) X(UniformMatrix4fv) X(UseProgram)      \
    X(VertexAttribPointer) X(Viewport)
// clang-format on

struct GlApi {
#define OBSCURA_GL_MEMBER(NAME) decltype(&::gl##NAME) NAME = nullptr;  // NOLINT: a name takes no parentheses
    OBSCURA_GL_FUNCTIONS(OBSCURA_GL_MEMBER)
#undef OBSCURA_GL_MEMBER
};

/// A current OpenGL 3.3 core context of this process. Never destroyed: it ends with the process, as OSMesa's
/// own state does.
struct GlContext {
    GlApi gl;
    std::array<unsigned char, 16 * 16 * 4> default_buffer{};  ///< unused; all drawing goes to textures
};

/// Loads OSMesa and makes a context current. LP_NUM_THREADS is read here, once per process.
/// Throws std::runtime_error with the step that failed.
void open_gl(GlContext& context);

}  // namespace obscura
