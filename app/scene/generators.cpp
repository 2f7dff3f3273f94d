#include "app/scene/generators.h"

#include "app/scene/key_row.h"
#include "scenes/city.h"
#include "scenes/generators.h"

namespace obscura {
namespace {

/// One parameter of a generator whose parameters are a P: its key, and the member it sets.
template <class P>
KeyRow<P> knob(const char* name, double P::*member, double lo, double hi, const char* doc) {
    return key_row(member, number_key(name, doc).in({lo, hi}));
}
template <class P>
KeyRow<P> knob(const char* name, int P::*member, double lo, double hi, const char* doc) {
    return key_row(member, integer_key(name, doc).in({lo, hi}));
}
template <class P>
KeyRow<P> seed_knob() {
    return knob("seed", &P::seed, 0, 2147483647, "Another number, another one of its kind.");
}

template <class P>
P params_of(const KeyRows<P>& knobs, const SceneTable& table) {
    P p;
    read_rows(knobs, table, p);
    return p;
}

template <class P>
std::string no_problem(const P&) {
    return {};
}

/// A shape out of a generator: `bound` is a number of triangles that it never exceeds.
template <class P>
ShapeSpec shape_of(const char* name, const char* doc, KeyRows<P> knobs, GeneratedModel (*make)(const P&),
                   double (*bound)(const P&), std::string (*problem_of)(const P&) = no_problem<P>) {
    ShapeSpec shape;
    shape.variant.name = name, shape.variant.doc = doc;
    shape.variant.keys = keys_of(knobs);
    shape.max_triangles = [knobs, bound](const SceneTable& t) {
        return static_cast<std::int64_t>(bound(params_of(knobs, t)));
    };
    shape.make = [knobs, make](const SceneTable& t) { return make(params_of(knobs, t)); };
    shape.problem = [knobs, problem_of](const SceneTable& t) { return problem_of(params_of(knobs, t)); };
    return shape;
}

ShapeSpec arcade_shape() {
    using P = ArcadeParams;
    return shape_of<P>(
        "arcade", "A row of round arches on columns along x. Slots: wall, trim.",
        {knob("bays", &P::bays, 1, 200, "Arches."),
         knob("bay_m", &P::bay_m, 0.5, 20, "From column axis to column axis."),
         knob("column_m", &P::column_m, 0.5, 30, "Floor to springing line."),
         knob("column_radius_m", &P::column_radius_m, 0.05, 2, "Of the shaft at its foot."),
         knob("wall_m", &P::wall_m, 0.3, 5, "Thickness of the wall on the arches."),
         knob("above_m", &P::above_m, 0.3, 20, "Wall between the crowns and the cornice."),
         knob("smoothness", &P::smoothness, 1, 20, "1: 24 facets around a column; each step adds 12.")},
        arcade, [](const P& p) { return 9000.0 * p.smoothness * (p.bays + 1); }, problem);
}

ShapeSpec stairs_shape() {
    using P = StairsParams;
    return shape_of<P>("stairs",
                       "A straight flight that climbs towards -z, with parapets. Slots: step, coping.",
                       {knob("steps", &P::steps, 1, 100, "Risers."),
                        knob("width_m", &P::width_m, 0.3, 100, "Between the parapets."),
                        knob("rise_m", &P::rise_m, 0.06, 1, "Height of a step."),
                        knob("going_m", &P::going_m, 0.1, 2, "Depth of a step."),
                        knob("parapet_m", &P::parapet_m, 0, 5, "Height of the parapets; 0 = none.")},
                       stairs, [](const P& p) { return 4000.0 + 30 * p.steps; });
}

ShapeSpec fence_shape() {
    using P = FenceParams;
    return shape_of<P>(
        "fence", "Thin round bars with spear finials, rails and posts along x. Slots: iron.",
        {knob("length_m", &P::length_m, 0.3, 500, "From the first post to the last."),
         knob("height_m", &P::height_m, 0.7, 10, "Tip of the bars."),
         knob("spacing_m", &P::spacing_m, 0.03, 2, "Between bar axes."),
         knob("bar_radius_m", &P::bar_radius_m, 0.002, 0.2, "Radius of a bar."),
         knob("post_every_m", &P::post_every_m, 0.2, 50, "About; posts divide the length evenly.")},
        fence,
        [](const P& p) {
            return 5000.0 + 310 * p.length_m / p.spacing_m + 700 * p.length_m / p.post_every_m;
        },
        problem);
}

ShapeSpec tree_shape() {
    using P = TreeParams;
    return shape_of<P>(
        "tree", "A broad-leaved tree; its leaves are thin solids. Slots: bark, leaf, young_leaf.",
        {knob("height_m", &P::height_m, 1.5, 60, "Top of the crown."),
         knob("crown_radius_m", &P::crown_radius_m, 0.4, 40, "Half the crown's width."),
         knob("trunk_m", &P::trunk_m, 0, 50, "Bare trunk below the crown."),
         knob("leaves", &P::leaves, 0, 1e6, "Four triangles each."),
         knob("leaf_m", &P::leaf_m, 0.02, 2, "Length of an average leaf."), seed_knob<P>()},
        tree, [](const P& p) { return 100000.0 + 4.0 * p.leaves; }, problem);
}

ShapeSpec lamp_post_shape() {
    using P = LampPostParams;
    return shape_of<P>(
        "lamp_post",
        "A street lamp with an open lantern. A point light at its bulb (height_m - 1.53 lantern_m) with "
        "near_m of 0.05 or more shines out between the bars. Slots: iron, bulb.",
        {knob("height_m", &P::height_m, 2, 12, "Tip of the finial."),
         knob("lantern_m", &P::lantern_m, 0.2, 1, "Width of the lantern.")},
        lamp_post, [](const P&) { return 3000.0; }, problem);
}

ShapeSpec planter_shape() {
    using P = PlanterParams;
    return shape_of<P>("planter",
                       "A terracotta pot with a clipped shrub. Slots: terracotta, earth, leaf, young_leaf.",
                       {knob("radius_m", &P::radius_m, 0.15, 3, "Of the rim."),
                        knob("height_m", &P::height_m, 0.2, 3, "Of the pot."),
                        knob("shrub_m", &P::shrub_m, 0, 3, "Radius of the shrub; 0 = none."),
                        knob("leaves", &P::leaves, 0, 1e6, "Four triangles each."), seed_knob<P>()},
                       planter, [](const P& p) { return 4000.0 + 4.0 * p.leaves; });
}

ShapeSpec hedge_shape() {
    using P = HedgeParams;
    return shape_of<P>("hedge", "A clipped hedge along x. Slots: core, leaf, young_leaf.",
                       {knob("length_m", &P::length_m, 0.3, 500, "Along x."),
                        knob("height_m", &P::height_m, 0.3, 20, "Of the top."),
                        knob("depth_m", &P::depth_m, 0.15, 50, "Along z."),
                        knob("leaves", &P::leaves, 0, 1e6, "Four triangles each."), seed_knob<P>()},
                       hedge, [](const P& p) { return 12.0 + 4.0 * p.leaves; });
}

ShapeSpec bench_shape() {
    using P = BenchParams;
    return shape_of<P>("bench", "A stone bench along x. Slots: stone.",
                       {knob("length_m", &P::length_m, 0.7, 20, "Of the seat."),
                        knob("height_m", &P::height_m, 0.3, 2, "Of the seat."),
                        knob("depth_m", &P::depth_m, 0.25, 3, "Of the seat.")},
                       bench, [](const P&) { return 500.0; });
}

ShapeSpec fountain_shape() {
    using P = FountainParams;
    return shape_of<P>("fountain", "A basin with a bowl on a baluster. Slots: stone, water.",
                       {knob("radius_m", &P::radius_m, 0.7, 20, "Of the basin."),
                        knob("height_m", &P::height_m, 1.6, 20, "Tip of the finial."),
                        knob("segments", &P::segments, 8, 1024, "Around.")},
                       fountain, [](const P& p) { return 200.0 * p.segments; });
}

ShapeSpec pavement_shape() {
    using P = PavementParams;
    return shape_of<P>(
        "pavement",
        "Flagstones with open joints, their tops at y = 0. Slots: joint, flag_light, flag, flag_dark.",
        {knob("width_m", &P::width_m, 0.2, 500, "Along x."),
         knob("depth_m", &P::depth_m, 0.2, 500, "Along z."),
         knob("stone_m", &P::stone_m, 0.05, 10, "Side of an average stone."),
         knob("joint_m", &P::joint_m, 0.001, 1, "Between stones."), seed_knob<P>()},
        pavement,
        [](const P& p) { return 12 + 20 * (p.width_m / p.stone_m + 2) * (p.depth_m / p.stone_m + 2); },
        problem);
}

ShapeSpec roof_tiles_shape() {
    using P = RoofTilesParams;
    return shape_of<P>(
        "roof_tiles",
        "A slope of barrel tiles that climbs towards -z from its eaves on the x axis. Slots: board, "
        "tile, tile_pale, tile_dark.",
        {knob("width_m", &P::width_m, 0.3, 300, "Along the eaves."),
         knob("slope_m", &P::slope_m, 0.5, 100, "Eaves to ridge, up the slope."),
         knob("pitch_deg", &P::pitch_deg, 0, 75, "Of the slope."),
         knob("tile_m", &P::tile_m, 0.06, 2, "Width of a tile."), seed_knob<P>()},
        roof_tiles, [](const P& p) { return 70 * (p.width_m / p.tile_m + 2) * (p.slope_m / 0.36 + 2); },
        problem);
}

ShapeSpec window_shape() {
    using P = WindowParams;
    return shape_of<P>(
        "window_frame", "A frame with glazing bars and no glass, its lower edge on y = 0. Slots: frame.",
        {knob("width_m", &P::width_m, 0.1, 50, "Outer."), knob("height_m", &P::height_m, 0.1, 50, "Outer."),
         knob("depth_m", &P::depth_m, 0.005, 2, "Along z."),
         knob("frame_m", &P::frame_m, 0.01, 2, "Face width."),
         knob("bar_m", &P::bar_m, 0.002, 1, "Face width of the bars."),
         knob("columns", &P::columns, 1, 100, "Of panes."), knob("rows", &P::rows, 1, 100, "Of panes.")},
        window_frame, [](const P& p) { return 48.0 + 12 * (p.columns + p.rows); }, problem);
}

ShapeSpec pierced_wall_shape() {
    using P = PiercedWallParams;
    return shape_of<P>(
        "pierced_wall", "A wall along x with a row of openings right through it. Slots: wall.",
        {knob("width_m", &P::width_m, 0.1, 500, "Along x."),
         knob("height_m", &P::height_m, 0.1, 100, "Of the wall."),
         knob("depth_m", &P::depth_m, 0.01, 20, "Thickness."),
         knob("openings", &P::openings, 0, 500, "How many."),
         knob("opening_width_m", &P::opening_width_m, 0.05, 50, "Of each opening."),
         knob("opening_height_m", &P::opening_height_m, 0.05, 50, "Of each opening."),
         knob("sill_m", &P::sill_m, 0.01, 50, "Lower edge of the openings.")},
        pierced_wall, [](const P& p) { return 60.0 + 50 * p.openings; }, problem);
}

ShapeSpec house_shape() {
    using P = HouseParams;
    return shape_of<P>(
        "house",
        "A plastered house with shuttered windows. Slots: plaster, trim, pane, shutter, roof, chimney_pot.",
        {knob("width_m", &P::width_m, 3.2, 200, "Along x."),
         knob("depth_m", &P::depth_m, 3.2, 200, "Along z."), knob("storeys", &P::storeys, 1, 60, "Floors."),
         knob("storey_m", &P::storey_m, 2.1, 10, "Height of a floor."),
         knob("bay_m", &P::bay_m, 1.3, 50, "About; windows divide each front evenly."),
         knob("roof_m", &P::roof_m, 0, 50, "Height of the hip roof; 0 = flat with a parapet."),
         knob("detail", &P::detail, 0, 4,
              "0 box, 1 cornice, 2 windows, 3 sills and lintels, 4 bars and shutters."),
         knob("fronts", &P::fronts, 0, 4,
              "Of +z, +x, -z, -x in this order, how many have windows with trim."),
         seed_knob<P>()},
        house, [](const P& p) {
            return 2000.0 +
                   p.storeys * (2 * (p.width_m + p.depth_m) / p.bay_m + 4) * (500 + 300 * p.storey_m);
        });
}

ShapeSpec figure_shape() {
    using P = FigureParams;
    return shape_of<P>("figure", "A person in a coat, facing +z. Slots: coat, trim, skin, hair, boot, eye.",
                       {knob("height_m", &P::height_m, 0.05, 100, "Without the hat."),
                        knob("girth", &P::girth, 0.3, 3, "Width and depth are scaled by it."),
                        knob("hat", &P::hat, 0, 2, "0 none, 1 pointed, 2 brimmed."),
                        knob("left_arm_deg", &P::left_arm_deg, 0, 170, "Raised sideways from hanging down."),
                        knob("right_arm_deg", &P::right_arm_deg, 0, 170, "The same.")},
                       figure, [](const P&) { return 60000.0; });
}

ShapeSpec lion_head_shape() {
    using P = LionHeadParams;
    return shape_of<P>(
        "lion_head",
        "A lion's head on a round plate whose back is at z = 0, a ring in its mouth. Slots: stone, dark, "
        "ring.",
        {knob("size_m", &P::size_m, 0.01, 100, "Diameter of the plate; the mane reaches a little beyond.")},
        lion_head, [](const P&) { return 60000.0; });
}

ShapeSpec cliffs_shape() {
    using P = CliffsParams;
    return shape_of<P>(
        "cliffs", "A rocky coast along x, the sea (y = 0) on its +z side. Slots: rock, layer, grass, sand.",
        {knob("width_m", &P::width_m, 1, 10000, "Along the shore."),
         knob("height_m", &P::height_m, 1, 1000, "Of the face."),
         knob("meander_m", &P::meander_m, 0, 1000, "How far headlands and bays leave the straight shore."),
         knob("roughness", &P::roughness, 0, 3, "Of the face."),
         knob("columns", &P::columns, 2, 4096, "Squares along the shore."),
         knob("rows", &P::rows, 2, 4096, "Squares from the sea to the plateau."), seed_knob<P>()},
        cliffs, [](const P& p) { return 2.0 * p.columns * p.rows + 6.0 * (p.columns + p.rows); });
}

ShapeSpec city_shape() {
    const auto params = [](const SceneTable& t) {
        CityParams p;
        p.triangles = integer(t, "triangles"), p.extent_m = number(t, "extent_m");
        p.seed = static_cast<int>(integer(t, "seed"));
        return p;
    };
    ShapeSpec shape;
    shape.variant = {
        "city",
        "A town of closed buildings with streets, squares and trees. Slots: asphalt, kerb, sidewalk, lawn, "
        "setts, facade_sand, facade_brick, facade_rose, facade_white, facade_grey, facade_ochre, trim, pane, "
        "pane_lit, roof_tile, roof_slate, roof_flat, metal, wood, bark, leaf.",
        {integer_key("triangles", "Wanted; the result is within 5 %.")
             .in({1000, 1e6})
             .or_else(CityParams{}.triangles),
         number_key("extent_m", "Side of the square it covers, 60 to 4000; 0 = to suit the triangles.")
             .in({0, 4000})
             .or_else(0.0),
         integer_key("seed", "Another number, another town.")
             .in({0, 2147483647})
             .or_else(std::int64_t{CityParams{}.seed})}};
    shape.max_triangles = [](const SceneTable& t) { return integer(t, "triangles") * 21 / 20; };
    shape.make = [params](const SceneTable& t) { return city(params(t)); };
    shape.problem = [params](const SceneTable& t) -> std::string {
        const double extent_m = params(t).extent_m;
        return extent_m == 0 || extent_m >= 60 ? "" : "'extent_m' must be 0 or at least 60";
    };
    return shape;
}

}  // namespace

std::vector<ShapeSpec> generator_shapes() {
    return {arcade_shape(),     stairs_shape(),    fence_shape(),        tree_shape(),     lamp_post_shape(),
            planter_shape(),    hedge_shape(),     bench_shape(),        fountain_shape(), pavement_shape(),
            roof_tiles_shape(), window_shape(),    pierced_wall_shape(), house_shape(),    city_shape(),
            figure_shape(),     lion_head_shape(), cliffs_shape()};
}

}  // namespace obscura
