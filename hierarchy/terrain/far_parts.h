#pragma once
// Days that are made in parts: by several machines, or by one that was stopped in between. What each has made
// is a file like that of the whole, in which the units of some groups of suns are absent.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hierarchy/terrain/far_day.h"

namespace obscura {

/// Part `part` of `of`, 1 <= part <= of: groups part - 1, part - 1 + of, ..., so that all parts have of the
/// hours in which shadows are long. None where there are fewer groups.
std::vector<int> groups_of_part(int groups, int part, int of);

/// Groups of which some unit is absent, or is not what was written.
std::vector<int> missing_groups(const FarDay& day);

/// A group's bytes; none when it is missing.
CodedGroup coded_group(const FarDay& day, int group);

/// All that the days have, which are of the same ground, suns and settings. Where two have a group, they have
/// the same bytes, or InputError names the second.
struct NamedDay {
    FarDay day;
    std::string name;
};
FarDay joined(const FarDay& like, std::span<const NamedDay> parts);

/// "suns 17 to 32 and 49 to 50", counted from 1.
std::string suns_text(const FarDay& day, std::span<const int> groups);

/// Makes those of `groups` that `known` is missing, one after another, and calls keep(all there is by then)
/// after each. The same bits whatever was known. Has no units when cancelled.
FarDay make_missing(const HeightField& field, const FarDay& known, std::span<const int> groups,
                    const Exec& exec, const FarDayWatch& watch,
                    const std::function<void(const FarDay&)>& keep = {});

}  // namespace obscura
