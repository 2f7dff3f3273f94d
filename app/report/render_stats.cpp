#include "app/report/render_stats.h"

#include "app/frame/sun_hours_text.h"
#include "app/scene/aov.h"

namespace obscura {
namespace {

void put_memory(JsonWriter& json, const RenderReport& report) {
    json.key("memory").begin_object();
    json.member("limit_bytes", report.run.limit_mib << 20);
    json.member("estimate_bytes", report.memory.total());
    json.member("meshes_bytes", report.memory.meshes);
    json.member("textures_bytes", report.memory.textures);
    json.member("shadow_maps_bytes", report.memory.shadow_maps);
    json.member("frame_bytes", report.memory.frame);
    json.member("peak_resident_bytes", peak_resident_bytes());
    json.end_object();
}

void put_seconds(JsonWriter& json, const FrameReport& frame) {
    const FrameStats& s = frame.stats;
    json.key("seconds").begin_object();
    json.member("surface", s.surface_s).member("setup", s.setup_s).member("shadow", s.shadow_s);
    json.member("shadow_resolution", s.resolution_s).member("shadow_needed", s.needed_s);
    json.member("shadow_sky", s.sky_s);
    json.member("tiles", s.tiles_s);
    json.member("glare", s.glare ? s.glare->total_s : 0.0).member("psf", s.glare ? s.glare->psf_s : 0.0);
    json.member("render", s.total_s).member("write", frame.write_s);
    json.end_object();
}

void put_counts(JsonWriter& json, const FrameStats& s) {
    json.key("counts").begin_object();
    json.member("triangles", s.triangles).member("records", s.records).member("bin_items", s.bin_items);
    json.member("samples", s.samples).member("covered_samples", s.covered_samples);
    json.member("shadow_maps", s.shadow_maps).member("shadow_bytes", s.shadow_bytes);
    json.member("exact_samples", s.exact.samples).member("exact_groups", s.exact.groups);
    json.member("exact_triangles", s.exact.triangles);
    json.end_object();
}

void put_glare(JsonWriter& json, const GlareStats& s) {
    json.key("glare").begin_object();
    json.member("sources", s.sources).member("method", s.fft ? "fft" : "splats").member("reason", s.reason);
    json.member("spread", s.spread)
        .member("lost", s.lost)
        .member("margin_px", s.margin_px)
        .member("blocked", s.blocked)
        .member("psf_kept", s.kept);
    json.member("kernels", s.kernels).member("own_kernel_sources", s.own_kernel_sources);
    json.member("wavelengths", s.wavelengths).member("cycles_per_px", s.cycles_per_px);
    json.member("captured", s.captured).end_object();
}

void put_sun_hours(JsonWriter& json, const SunHoursStats& s) {
    json.key("sun_hours").begin_object();
    json.member("light", s.light).member("date", date_text(s.path));
    json.member("steps", s.path.steps).member("suns", s.suns).member("passes", s.passes);
    json.member("sunlit_h", s.sunlit_h()).member("order_s", s.order_s).member("total_s", s.total_s);
    json.member("exact_samples", s.exact.samples).member("exact_groups", s.exact.groups);
    json.member("exact_triangles", s.exact.triangles).end_object();
}

std::int64_t count(std::uint64_t n) {
    return static_cast<std::int64_t>(n);
}

void put_light(JsonWriter& json, const LightShadowStats& s) {
    json.begin_object();
    json.member("light", s.light).member("method", name_of(shadow_method_words, s.method));
    if (s.method == ShadowMethod::day) {
        json.member("sun", s.sun_text).member("sun_off_deg", s.sun_off_deg).member("casters", s.casters);
    } else if (s.method == ShadowMethod::exact) {
        json.member("casters", s.casters).member("points", s.samples);
        if (s.penumbra_px > 0) json.member("penumbra_px", static_cast<double>(s.penumbra_px));
    } else {
        json.member("resolution", s.resolution);
    }
    json.member("views", s.views).member("bytes", count(s.bytes));
    json.member("kept", s.kept).member("lookup_s", s.lookup_s);
    if (s.found) {
        json.member("magnification", s.found->magnification).member("capped", s.found->capped);
    }
    if (s.method == ShadowMethod::stack) {
        json.member("from_cache", s.from_cache).member("anisotropy", s.anisotropy);
        json.member("nodes_full", count(s.nodes.full)).member("nodes_empty", count(s.nodes.empty));
        json.member("nodes_leaf", count(s.nodes.leaf));
    }
    if (s.method == ShadowMethod::compressed) {
        const BuildStats& b = s.build;
        json.member("code", name_of(s.code));
        json.member("scope", s.scope == ShadowScope::frame ? "frame" : "full");
        json.member("from_cache", s.from_cache).member("needed", s.needed);
        json.member("nodes_full", count(s.nodes.full)).member("nodes_empty", count(s.nodes.empty));
        json.member("nodes_leaf", count(s.nodes.leaf)).member("nodes_visited", count(b.nodes_visited));
        json.member("certified_cover", count(b.certified_cover));
        json.member("certified_mesh", count(b.certified_mesh));
        json.member("texels_rasterized", count(b.texels_rasterized));
        json.member("list_operations", count(b.list_operations));
        json.member("setup_s", b.setup_s).member("encode_s", s.encode_s);
    }
    json.member("build_s", s.build.build_s);
    json.end_object();
}

void put_file(JsonWriter& json, const WrittenFile& file) {
    json.begin_object();
    json.member("file", file.file).member("aov", aov_name(file.aov)).member("bytes", file.bytes);
    if (file.depth) {
        json.member("nearest_m", double{file.depth->nearest_m});
        json.member("farthest_m", double{file.depth->farthest_m});
    }
    json.end_object();
}

}  // namespace

std::string stats_json(const RenderReport& report) {
    JsonWriter json;
    json.begin_object();
    put_origin(json, report.run);
    put_execution(json, report.run.exec);
    put_picture_size(json, report.run);
    put_times(json, report.run);
    put_memory(json, report);
    json.key("frames").begin_list();
    for (const FrameReport& frame : report.frames) {
        json.begin_object().member("frame", frame.frame);
        put_seconds(json, frame);
        put_counts(json, frame.stats);
        json.key("lights").begin_list();
        for (const LightShadowStats& light : frame.stats.lights)
            put_light(json, light);
        json.end_list();
        if (frame.stats.glare) put_glare(json, *frame.stats.glare);
        if (frame.stats.sun_hours) put_sun_hours(json, *frame.stats.sun_hours);
        json.key("files").begin_list();
        for (const WrittenFile& file : frame.files)
            put_file(json, file);
        json.end_list().end_object();
    }
    json.end_list().end_object();
    return json.finish();
}

}  // namespace obscura
