#include "app/report/pair_stats.h"

#include "app/report/pair_notes.h"

namespace obscura {
namespace {

void put_seconds(JsonWriter& json, const StereoFrameReport& frame) {
    const StereoTimes& t = frame.times;
    json.key("seconds").begin_object();
    json.member("view", t.view_s).member("edit", t.edit_s).member("solve", t.solve_s);
    json.member("upsample", t.upsample_s).member("mesh", t.mesh_s).member("render", t.render_s);
    json.member("measure", t.measure_s).member("pair", t.total_s);
    json.member("compare", frame.compare_s).member("write", frame.write_s).end_object();
}

void put_solve(JsonWriter& json, const StereoFrameReport& frame) {
    const SolveReport& r = frame.solve;
    json.key("solve").begin_object();
    json.member("method", solver_name(frame.solver))
        .member("converged", r.converged)
        .member("warm", frame.warm);
    json.member("iterations", r.iterations).member("residual", r.residual);
    json.member("error_max_px", r.error_max_px).member("error_rms_px", r.error_rms_px);
    json.member("setup_s", r.setup_s).member("solve_s", r.solve_s);
    json.key("unsatisfied").begin_list();
    for (const Unsatisfied& u : r.unsatisfied) {
        json.begin_object().member("edit", u.name).member("against", u.against);
        json.member("wanted_px", u.wanted_px).member("reached_px", u.reached_px);
        json.member("worst_px", u.worst_px).member("pixels", u.pixels).end_object();
    }
    json.end_list().end_object();
}

void put_conflicts(JsonWriter& json, const std::vector<Conflict>& conflicts) {
    json.key("conflicts").begin_list();
    for (const Conflict& c : conflicts) {
        json.begin_object().member("kind", conflict_name(c.kind)).member("what", c.what);
        json.member("pixels", c.pixels).member("inherited", c.inherited).member("worst_px", c.worst_px);
        json.end_object();
    }
    json.end_list();
}

void put_error(JsonWriter& json, const char* name, const DisparityError& e) {
    json.key(name).begin_object();
    json.member("pixels", e.pixels).member("within", e.within).member("max_px", e.max_px);
    json.member("rms_px", e.rms_px).end_object();
}

void put_frame(JsonWriter& json, const StereoFrameReport& frame) {
    json.begin_object().member("frame", frame.frame);
    put_seconds(json, frame);
    json.member("margin_px", frame.margin_px).member("map_scale", frame.map_scale);
    put_solve(json, frame);
    put_conflicts(json, frame.conflicts);
    const ReprojectStats& r = frame.reprojection;
    json.key("reprojection").begin_object();
    json.member("vertices_seen", r.vertices_seen).member("vertices_hidden", r.vertices_hidden);
    json.member("triangles_in", r.triangles_in).member("triangles_out", r.triangles_out);
    json.member("rounds", r.rounds).member("within", r.within).end_object();
    put_error(json, "realised", frame.realised);
    put_error(json, "left_picture", frame.left);
    put_error(json, "right_picture", frame.right);
    if (frame.temporal) put_error(json, "temporal", *frame.temporal);
    json.member("cracks", frame.cracks).member("warp_holes", frame.warp_holes);
    json.member("estimate_bytes", frame.bytes);
    json.key("notes").begin_list();
    for (const std::string& note : frame.notes)
        json.value(note);
    json.end_list().key("files").begin_list();
    for (const StereoWritten& f : frame.files)
        json.begin_object()
            .member("file", f.file)
            .member("shows", f.role)
            .member("bytes", f.bytes)
            .end_object();
    json.end_list().end_object();
}

}  // namespace

StereoFrameReport frame_report(int frame, const StereoPair& pair, const StereoSettings& settings) {
    StereoFrameReport r;
    r.frame = frame;
    r.times = pair.times;
    r.margin_px = pair.view.margin_px;
    r.map_scale = settings.map_scale;
    r.solver = settings.solver.method;
    r.warm = pair.warm;
    r.solve = pair.solution.report;
    r.conflicts = pair.edited.conflicts;
    r.reprojection = pair.reprojection;
    r.realised = pair.realised.error;
    r.left = pair.left_error;
    r.right = pair.right_error;
    if (pair.temporal) r.temporal = pair.temporal->error;
    r.cracks = pair.eyes.left_map.cracks + pair.eyes.right_map.cracks;
    r.bytes = pair.bytes;
    r.notes = stereo_notes(pair, settings);
    return r;
}

std::string stereo_stats_json(const StereoReport& report) {
    JsonWriter json;
    json.begin_object();
    put_origin(json, report.run);
    json.member("layout", report.layout).member("swapped_eyes", report.swapped_eyes);
    json.member("preview", report.preview);
    put_execution(json, report.run.exec);
    put_picture_size(json, report.run);
    json.member("limit_bytes", report.run.limit_mib << 20);
    json.member("peak_resident_bytes", peak_resident_bytes());
    put_times(json, report.run);
    json.key("frames").begin_list();
    for (const StereoFrameReport& frame : report.frames)
        put_frame(json, frame);
    json.end_list().end_object();
    return json.finish();
}

}  // namespace obscura
