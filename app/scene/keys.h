#pragma once
// Every key of the scene format. Start reading at scene_schema_root().

#include "app/scene/schema.h"

namespace obscura {

const TableSpec& scene_schema_root();
const TableSpec& camera_table();
const TableSpec& mesh_table();
const TableSpec& terrain_table();
const TableSpec& material_table();
const TableSpec& light_table();
const TableSpec& shadow_table();
KeySpec shadow_cache_key();  ///< also stands in [shadow] itself
const TableSpec& sky_table();
const TableSpec& render_table();
const TableSpec& output_table();
const TableSpec& limits_table();
const TableSpec& optics_table();
const TableSpec& stereo_table();
const TableSpec& stereo_edit_table();
const TableSpec& frames_table();

}  // namespace obscura
