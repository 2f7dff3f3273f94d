#include "bench/raster/gl_api.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

namespace obscura {
namespace {

constexpr const char* library_name = "libOSMesa.so.8";

template <class Fn>
Fn symbol(void* library, const char* name) {
    void* address = dlsym(library, name);
    if (address == nullptr) throw std::runtime_error(fmt::format("{} lacks {}", library_name, name));
    return reinterpret_cast<Fn>(address);
}

}  // namespace

void open_gl(GlContext& context) {
    void* library = dlopen(library_name, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) throw std::runtime_error(dlerror());
    const auto create = symbol<decltype(&OSMesaCreateContextAttribs)>(library, "OSMesaCreateContextAttribs");
    const auto make_current = symbol<decltype(&OSMesaMakeCurrent)>(library, "OSMesaMakeCurrent");
    const auto get_proc = symbol<decltype(&OSMesaGetProcAddress)>(library, "OSMesaGetProcAddress");

    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              0,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    OSMesaContext mesa = create(attributes, nullptr);
    if (mesa == nullptr) throw std::runtime_error("OSMesa gives no OpenGL 3.3 core context");
    if (make_current(mesa, context.default_buffer.data(), GL_UNSIGNED_BYTE, 16, 16) == GL_FALSE) {
        throw std::runtime_error("OSMesa's context cannot be made current");
    }
#define OBSCURA_GL_LOAD(NAME)                                                            \
    context.gl.NAME = reinterpret_cast<decltype(context.gl.NAME)>(get_proc("gl" #NAME)); \
    if (context.gl.NAME == nullptr) throw std::runtime_error("OSMesa lacks gl" #NAME);
    OBSCURA_GL_FUNCTIONS(OBSCURA_GL_LOAD)
#undef OBSCURA_GL_LOAD
}

}  // namespace obscura
