#include "hierarchy/terrain/far_parts.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"

namespace obscura {
namespace {

std::span<const FarUnit> units_of(const FarDay& day, int group) {
    const auto tiles = static_cast<std::size_t>(day.tiles());
    return std::span(day.units).subspan(static_cast<std::size_t>(group) * tiles, tiles);
}

std::vector<CodedGroup> coded_groups(const FarDay& day) {
    std::vector<CodedGroup> groups;
    groups.reserve(static_cast<std::size_t>(day.groups()));
    for (int group = 0; group < day.groups(); ++group)
        groups.push_back(coded_group(day, group));
    return groups;
}

}  // namespace

std::vector<int> groups_of_part(int groups, int part, int of) {
    CHECK(part >= 1 && part <= of);
    std::vector<int> mine;
    for (int group = part - 1; group < groups; group += of)
        mine.push_back(group);
    return mine;
}

CodedGroup coded_group(const FarDay& day, int group) {
    CodedGroup coded;
    for (const FarUnit& unit : units_of(day, group)) {
        const auto bytes = day.bytes.subspan(unit.offset, unit.bytes);
        if (bulk_hash(bytes.data(), bytes.size()) != unit.hash) return {};
        coded.emplace_back(bytes.begin(), bytes.end());
    }
    return coded;
}

std::vector<int> missing_groups(const FarDay& day) {
    std::vector<int> missing;
    for (int group = 0; group < day.groups(); ++group)
        if (coded_group(day, group).empty()) missing.push_back(group);
    return missing;
}

FarDay joined(const FarDay& like, std::span<const NamedDay> parts) {
    std::vector<CodedGroup> groups(static_cast<std::size_t>(like.groups()));
    for (const NamedDay& part : parts) {
        CHECK(part.day.grid == like.grid && part.day.params == like.params && part.day.suns == like.suns);
        for (int group = 0; group < like.groups(); ++group) {
            CodedGroup coded = coded_group(part.day, group);
            CodedGroup& there = groups[static_cast<std::size_t>(group)];
            if (coded.empty()) continue;
            if (!there.empty() && there != coded) {
                const int one[] = {group};
                throw InputError(part.name,
                                 "has other shadows of " + suns_text(like, one) + " than another part");
            }
            there = std::move(coded);
        }
    }
    return with_groups(like, groups);
}

std::string suns_text(const FarDay& day, std::span<const int> groups) {
    std::string out = "suns";
    for (std::size_t i = 0; i < groups.size(); ++i) {
        // Runs of groups are told as one.
        std::size_t last = i;
        while (last + 1 < groups.size() && groups[last + 1] == groups[last] + 1)
            ++last;
        const FarDay::Suns from = day.suns_of(groups[i]), to = day.suns_of(groups[last]);
        const bool end = last + 1 == groups.size();
        out += fmt::format("{}{} to {}",
                           i == 0 ? " "
                           : end  ? " and "
                                  : ", ",
                           from.first + 1, to.first + to.count);
        i = last;
    }
    return out;
}

FarDay make_missing(const HeightField& field, const FarDay& known, std::span<const int> groups,
                    const Exec& exec, const FarDayWatch& watch,
                    const std::function<void(const FarDay&)>& keep) {
    std::vector<CodedGroup> coded = coded_groups(known);
    int done = 0;
    for (const int group : groups) {
        CodedGroup& own = coded[static_cast<std::size_t>(group)];
        done += known.suns_of(group).count;
        if (!own.empty()) continue;
        own = make_far_group(field, known, group, exec, watch.cancel);
        if (own.empty()) {
            FarDay none = known;
            none.units.clear();
            return none;
        }
        if (keep) keep(with_groups(known, coded));
        if (watch.progress) watch.progress(done);
    }
    return with_groups(known, coded);
}

}  // namespace obscura
