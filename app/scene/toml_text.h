#pragma once
// Values as TOML text.

#include <string>

#include "app/scene/value.h"

namespace obscura {

/// A value on one line, tables inline; numbers in the shortest form that reads back to the same bits.
std::string toml_text(const SceneValue& value);

/// A key, quoted when TOML asks for it.
std::string toml_key(const std::string& key);

/// A whole table as a TOML document.
std::string toml_document(const SceneTable& root);

}  // namespace obscura
