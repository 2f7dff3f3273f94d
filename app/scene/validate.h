#pragma once
// Raw table + schema -> table whose every key has the declared type and range, with defaults filled in, in
// the schema's order. What needs more than one key to judge is in rules.h.

#include <string>
#include <vector>

#include "app/scene/schema.h"
#include "app/scene/value.h"

namespace obscura {

/// Throws InputError at `place`.
[[noreturn]] void fail_at(const Place& place, const std::vector<std::string>& sources,
                          const std::string& message);

/// Fails at `place` when `name` is not among the `known` ones; `what` they are ("material").
void require_known(const std::string& name, const Place& place, const std::vector<std::string>& known,
                   const char* what, const std::vector<std::string>& sources);

/// Validates `raw` (written at `place`) against `spec`. Integers become doubles where numbers are wanted,
/// single numbers become triples where colours or scales are wanted. Throws InputError: unknown key (with the
/// nearest known one), wrong type, range, missing key.
SceneTable validate_table(const SceneTable& raw, const Place& place, const TableSpec& spec,
                          const std::vector<std::string>& sources);

/// The variant that a validated table chose; null when its spec has none.
const VariantSpec* variant_of(const SceneTable& table, const TableSpec& spec);

}  // namespace obscura
