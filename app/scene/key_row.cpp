#include "app/scene/key_row.h"

namespace obscura {
namespace {

double number_of(const SceneValue& value) {
    return std::get<double>(value.data);
}

}  // namespace

void take(const SceneValue& value, bool& to) {
    to = std::get<bool>(value.data);
}

void take(const SceneValue& value, int& to) {
    to = static_cast<int>(std::get<std::int64_t>(value.data));
}

void take(const SceneValue& value, std::int64_t& to) {
    to = std::get<std::int64_t>(value.data);
}

void take(const SceneValue& value, double& to) {
    to = number_of(value);
}

void take(const SceneValue& value, float& to) {
    to = static_cast<float>(number_of(value));
}

void take(const SceneValue& value, Vec3d& to) {
    const SceneList& list = std::get<SceneList>(value.data);
    to = {number_of(list.at(0)), number_of(list.at(1)), number_of(list.at(2))};
}

void take(const SceneValue& value, Vec3f& to) {
    Vec3d wide;
    take(value, wide);
    to = to_float(wide);
}

void take(const SceneValue& value, std::string& to) {
    to = std::get<std::string>(value.data);
}

void take(const SceneValue& value, std::optional<std::array<double, 2>>& to) {
    const SceneList& list = std::get<SceneList>(value.data);
    to = {number_of(list.at(0)), number_of(list.at(1))};
}

}  // namespace obscura
