#include "app/scene/light_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scene/build.h"
#include "app/scene/key_ranges.h"
#include "app/scene/keys.h"
#include "app/scene/validate.h"
#include "core/num.h"
#include "core/sun.h"

namespace obscura {
namespace {

using namespace key_ranges;
using Sources = std::vector<std::string>;

/// Unit vector towards (azimuth clockwise from north = -Z, elevation above the horizon).
Vec3d towards(double azimuth_deg, double elevation_deg) {
    const double level = num::cos_deg(elevation_deg);
    return {level * num::sin_deg(azimuth_deg), num::sin_deg(elevation_deg),
            -level * num::cos_deg(azimuth_deg)};
}

/// Relative optical air mass. F. Kasten and A. T. Young, "Revised optical air mass tables and approximation
/// formula", Applied Optics 28 (1989), equation 3. elevation_deg >= 0, as seen.
double air_mass(double elevation_deg) {
    return 1.0 / (num::sin_deg(elevation_deg) + 0.50572 * num::pow(elevation_deg + 6.07995, -1.6364));
}

/// Optical depths of clear air at 615, 535 and 445 nm: Rayleigh scattering (0.008569 / um^4, rounded) plus
/// 0.06, 0.08 and 0.10 for aerosol and ozone.
constexpr Vec3d clear_air{0.12, 0.19, 0.31};

/// The years of the solar model's dates, is_solar_date().
constexpr Range solar_years{1800, 2200};

/// How large a disc the light fills in the sky.
KeyRows<Light> disc_rows(double usual_deg) {
    return {
        key_row(&Light::angular_diameter_deg,
                number_key("angular_diameter_deg",
                           "Angle that the light fills in the sky, a disc equally bright everywhere: what "
                           "makes penumbrae. 0: shadows are hard.")
                    .in({0, 90})
                    .or_else(usual_deg))};
}

// --- directional

KeyRows<Light> directional_rows() {
    return disc_rows(0) +
           KeyRows<Light>{
               {number_key("azimuth_deg", "Where the light comes from, clockwise from north: 90 is east.")
                    .in(turns)
                    .need()
                    .animate()},
               {number_key("elevation_deg", "Height above the horizon of where the light comes from.")
                    .in({-90, 90})
                    .need()
                    .animate()},
               key_row(&Light::color, vec3_or_number_key("irradiance_w_m2",
                                                         "On a surface that faces the light, per channel.")
                                          .in(brightness)
                                          .or_else(Vec3d{3, 3, 3})
                                          .animate()),
           };
}

void finish_directional(const SceneTable& table, Light& light) {
    light.direction = -towards(number(table, "azimuth_deg"), number(table, "elevation_deg"));
}

// --- sun

KeyRows<Light> sun_rows() {
    return disc_rows(0.53) +
           KeyRows<Light>{
               {number_key("latitude_deg", "North is positive.").in({-90, 90}).need()},
               {number_key("longitude_deg", "East is positive.").in({-180, 180}).need()},
               {date_time_key("time",
                              "Date and time with offset from UTC, as in 2026-06-21T18:00:00+02:00. A "
                              "leap second (60) is the first second of the next minute.")
                    .in(solar_years)
                    .need()
                    .animate()},
               {number_key("extraterrestrial_w_m2",
                           "Irradiance per channel above the atmosphere, in the scene's scale. What arrives "
                           "is dimmed and reddened by clear air: exp(-depth * air mass), with depths 0.12, "
                           "0.19, 0.31 for red, green, blue and the air mass of Kasten and Young (1989).")
                    .in(brightness)
                    .or_else(5.0)
                    .animate()},
               key_row_if_given(&Light::color,
                                vec3_or_number_key("irradiance_w_m2",
                                                   "Instead of that: what arrives on a surface that faces "
                                                   "the sun. Below the horizon there is "
                                                   "no sun either way.")
                                    .in(brightness)
                                    .animate()),
               {time_of_day_key("from",
                                "Of the sun's path over the day of 'time', by the clock of its offset: "
                                "sun_hours (see [[output]]) are counted along it. Pictures show the sun at "
                                "'time'.")
                    .or_else("00:00")},
               {time_of_day_key("to", "End of the path, later than 'from'; 24:00 is the end of the day.")
                    .or_else("24:00")},
               {integer_key("steps",
                            "Parts of the path, each with a sun at its middle. What stands in the sun or in "
                            "shadow for less may be missed; every time the sun comes or goes costs an error "
                            "of up to half a step.")
                    .in({1, 1440})
                    .or_else(SunPath{}.steps)},
           };
}

/// The way over the day of `time`, as its offset has that day.
SunPath sun_path_of(const SceneTable& table, const DateTime& time) {
    SunPath path;
    path.year = time.year;
    path.month = time.month;
    path.day = time.day;
    path.ahead_of_utc_h = time.offset_minutes / 60.0;
    path.from_h = time_of_day(table, "from");
    path.to_h = time_of_day(table, "to");
    path.latitude_deg = number(table, "latitude_deg");
    path.longitude_deg = number(table, "longitude_deg");
    path.steps = static_cast<int>(integer(table, "steps"));
    return path;
}

void check_sun(const SceneTable& light, const Sources& sources) {
    if (time_of_day(light, "from") < time_of_day(light, "to")) return;
    fail_at(place_of(light, light.find("to")->place.source >= 0 ? "to" : "from"), sources,
            fmt::format("'to' ({}) must be later than 'from' ({}) on the same day; a path does not pass "
                        "midnight, and 24:00 is the day's end",
                        text(light, "to"), text(light, "from")));
}

void finish_sun(const SceneTable& table, Light& light) {
    const DateTime t = date_time(table, "time");
    const double hour_utc = t.hour + (t.minute - t.offset_minutes) / 60.0 +
                            (t.second + static_cast<double>(t.nanosecond) * 1e-9) / 3600.0;
    const SunPosition sun = solar_position(t.year, t.month, t.day, hour_utc, number(table, "latitude_deg"),
                                           number(table, "longitude_deg"));
    const double elevation = sun.apparent_elevation_deg;
    light.direction = -towards(sun.azimuth_deg, elevation);
    light.below_horizon = elevation <= 0;
    light.path = sun_path_of(table, t);
    if (light.below_horizon) {
        light.color = {0, 0, 0};
    } else if (!table.has("irradiance_w_m2")) {
        const double above = number(table, "extraterrestrial_w_m2"), mass = air_mass(elevation);
        const auto arriving = [&](double depth) { return above * num::exp(-depth * mass); };
        light.color = to_float(Vec3d{arriving(clear_air.x), arriving(clear_air.y), arriving(clear_air.z)});
    }
}

// --- point

/// Of all that have a position.
KeyRows<Light> lamp_rows() {
    return {
        key_row(&Light::position,
                vec3_key("position_m", "Position; of an area, its middle.").in(anywhere).need().animate()),
        key_row(&Light::near_m,
                number_key("near_m", "Nothing nearer to the light than this casts a shadow.").in(positive)),
        key_row(&Light::range_m,
                number_key("range_m", "The light ends smoothly at this distance.").in(positive)),
    };
}

KeyRows<Light> point_rows() {
    return lamp_rows() +
           KeyRows<Light>{
               key_row(&Light::color, vec3_or_number_key("intensity_w_sr", "Radiant intensity, per channel.")
                                          .in(brightness)
                                          .need()
                                          .animate()),
               key_row(
                   &Light::radius_m,
                   number_key("radius_m",
                              "Of the ball that shines, which looks like a disc equally bright everywhere "
                              "from any side. 0: shadows are hard.")
                       .in({0, 1e6})),
           };
}

void check_point(const SceneTable& light, const Sources& sources) {
    if (number(light, "near_m") < number(light, "range_m")) return;
    fail_at(place_of(light, light.find("near_m")->place.source >= 0 ? "near_m" : "range_m"), sources,
            "'near_m' must be less than 'range_m'");
}

// --- spot

KeyRows<Light> spot_rows() {
    return point_rows() +
           KeyRows<Light>{
               {vec3_key("look_at_m", "Point on the axis of the cone.").in(anywhere).need().animate()},
               key_row(&Light::inner_cone_deg,
                       number_key("inner_cone_deg", "Half angle of the cone of full power.")
                           .in({0, 85})
                           .animate()),
               key_row(&Light::outer_cone_deg,
                       number_key("outer_cone_deg",
                                  "Half angle beyond which there is no light; not less than inner_cone_deg.")
                           .in({0, 85, true})
                           .animate()),
           };
}

void finish_spot(const SceneTable& table, Light& light) {
    light.direction = normalize(vec3(table, "look_at_m") - light.position);
}

void check_spot(const SceneTable& light, const Sources& sources) {
    check_point(light, sources);
    if (vec3(light, "position_m") == vec3(light, "look_at_m")) {
        fail_at(place_of(light, "look_at_m"), sources, "'look_at_m' is the same point as 'position_m'");
    }
    if (length(vec3(light, "position_m") - vec3(light, "look_at_m")) < least_distance_m) {
        fail_at(place_of(light, "look_at_m"), sources,
                fmt::format("'look_at_m' is nearer to 'position_m' than {:g} m", least_distance_m));
    }
    if (number(light, "inner_cone_deg") > number(light, "outer_cone_deg")) {
        const bool inner = light.find("inner_cone_deg")->place.source >= 0;
        fail_at(place_of(light, inner ? "inner_cone_deg" : "outer_cone_deg"), sources,
                "'inner_cone_deg' must not be more than 'outer_cone_deg'");
    }
}

// --- area

constexpr Word<AreaShape> area_shape_words[] = {{"rectangle", AreaShape::rectangle},
                                                {"disc", AreaShape::disc}};

KeyRows<Light> area_rows() {
    return lamp_rows() +
           KeyRows<Light>{
               key_row(&Light::color, vec3_or_number_key("radiance_w_m2_sr", "Radiance, per channel.")
                                          .in(brightness)
                                          .need()
                                          .animate()),
               {vec3_key("look_at_m", "Point straight before the light.").in(anywhere).need().animate()},
               {number_key("roll_deg",
                           "Turns it about the way it looks. At 0 its height is as upright as can be; of one "
                           "that looks straight up or down, it points north.")
                    .in(turns)
                    .or_else(0.0)
                    .animate()},
               word_row(&Light::shape, area_shape_words, "shape", "disc: the ellipse in the rectangle."),
               key_row(&Light::width_m, number_key("width_m", "Whole width.").in(positive)),
               key_row(&Light::height_m, number_key("height_m", "Whole height.").in(positive)),
               key_row(&Light::two_sided, boolean_key("two_sided", "Shines to its back, too.")),
           };
}

void finish_area(const SceneTable& table, Light& light) {
    light.direction = normalize(vec3(table, "look_at_m") - light.position);
    const double upright = std::fabs(light.direction.y);
    const Vec3d up = upright < 0.999999 ? Vec3d{0, 1, 0} : Vec3d{0, 0, -1};
    const Vec3d across = normalize(cross(light.direction, up)), above = cross(across, light.direction);
    const double roll = number(table, "roll_deg");
    light.across = normalize(across * num::cos_deg(roll) + above * num::sin_deg(roll));
}

void check_area(const SceneTable& light, const Sources& sources) {
    check_point(light, sources);
    if (length(vec3(light, "position_m") - vec3(light, "look_at_m")) < least_distance_m) {
        fail_at(place_of(light, "look_at_m"), sources,
                fmt::format("'look_at_m' is nearer to 'position_m' than {:g} m", least_distance_m));
    }
}

// --- surface

KeyRows<Light> surface_rows() {
    return {
        key_row(&Light::material,
                text_key("material",
                         "What has it sheds the light of its emission_w_m2_sr, from the side that its "
                         "triangles face. Materials of files and slots of shapes are MESH/NAME.")
                    .need()),
        key_row(&Light::near_m, number_key("near_m",
                                           "Nothing nearer to a place that shines than this casts a "
                                           "shadow.")
                                    .in(positive)
                                    .or_else(0.001)),
        key_row(&Light::range_m,
                number_key("range_m", "The light ends smoothly at this distance.").in(positive)),
    };
}

}  // namespace

const std::vector<LightKindRow>& light_kinds() {
    static const std::vector<LightKindRow> all{
        {LightKind::directional, "directional", "Parallel light from a given direction.", directional_rows(),
         finish_directional, nullptr},
        {LightKind::sun, "sun", "Parallel light from where the sun stands at a place and time.", sun_rows(),
         finish_sun, check_sun},
        {LightKind::point, "point", "Light from a point to all sides.", point_rows(), nullptr, check_point},
        {LightKind::spot, "spot", "Light from a point into a cone.", spot_rows(), finish_spot, check_spot},
        {LightKind::area, "area",
         "Light from a rectangle or an ellipse, as bright from wherever it is seen. It is not seen itself: "
         "give a mesh there the same emission.",
         area_rows(), finish_area, check_area},
        {LightKind::surface, "surface",
         "Light from all surfaces of a material that shines: lamps of any shape, of which 64 points and more "
         "are asked. With one sample, maps or no shadows it is a point at its middle that gives off as much "
         "to all sides, and nothing nearer to that than what shines casts a shadow.",
         surface_rows(), nullptr, check_point},
    };
    return all;
}

const char* light_kind_name(LightKind kind) {
    const auto row = std::find_if(light_kinds().begin(), light_kinds().end(),
                                  [&](const LightKindRow& r) { return r.kind == kind; });
    return row->name;
}

const LightKindRow& light_kind_of(const SceneTable& light) {
    return *std::find_if(light_kinds().begin(), light_kinds().end(),
                         [&](const LightKindRow& r) { return text(light, "type") == r.name; });
}

const TableSpec& light_table() {
    static const TableSpec spec = [] {
        std::vector<VariantSpec> variants;
        std::vector<std::string> names;
        for (const LightKindRow& kind : light_kinds()) {
            variants.push_back({kind.name, kind.doc, keys_of(kind.keys)});
            names.emplace_back(kind.name);
        }
        return TableSpec{"[[light]]",
                         "A light. Directions: north is -Z, east is +X, up is +Y.",
                         {
                             name_key("id", "Name, unique among lights.").need(),
                             choice_key("type", names, "Kind of light.").need(),
                             table_key("shadow", shadow_table()),
                         },
                         "type",
                         std::move(variants)};
    }();
    return spec;
}

SceneLight light_of(const SceneTable& table) {
    const LightKindRow& kind = light_kind_of(table);
    SceneLight result;
    result.light.id = text(table, "id");
    result.light.kind = kind.kind;
    read_rows(kind.keys, table, result.light);
    if (kind.finish != nullptr) kind.finish(table, result.light);
    result.shadow = shadow_settings_of(subtable(table, "shadow"));
    return result;
}

}  // namespace obscura
