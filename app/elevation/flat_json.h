#pragma once
// Objects of numbers and texts in JSON, as they lie beside elevation models.

#include <map>
#include <string>
#include <string_view>

namespace obscura {

/// The numbers of one flat object; texts, true, false and null are read over. Objects and lists within, names
/// twice, anything that is not JSON: InputError with line and column.
std::map<std::string, double> json_numbers(std::string_view text, const std::string& name);

}  // namespace obscura
