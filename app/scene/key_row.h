#pragma once
// A key of the format and the member that it sets, in one row: from it follow validation, the format's page,
// the default (the struct's own) and how the value is read.
//
//     static const KeyRows<Sky> rows{
//         key_row(&Sky::ambient, number_key("ambient", "Scale of ...").in({0, 1000})),
//
// Keys whose meaning needs several keys are rows without a member; whoever reads the struct reads these.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/schema.h"
#include "app/scene/words.h"

namespace obscura {

template <class S>
struct KeyRow {
    KeySpec key;
    std::function<void(const SceneValue&, S&)> read = nullptr;  ///< null: the key sets no member alone
};
template <class S>
using KeyRows = std::vector<KeyRow<S>>;

/// What the schema wants of the rows.
template <class S>
std::vector<KeySpec> keys_of(const KeyRows<S>& rows) {
    std::vector<KeySpec> keys;
    for (const KeyRow<S>& row : rows)
        keys.push_back(row.key);
    return keys;
}

/// Sets the members of the rows whose keys a validated table has.
template <class S>
void read_rows(const KeyRows<S>& rows, const SceneTable& table, S& to) {
    for (const KeyRow<S>& row : rows) {
        const SceneEntry* entry = row.read ? table.find(row.key.name) : nullptr;
        if (entry != nullptr) row.read(entry->value, to);
    }
}

// --- one key, one member

// A validated value as a member has it.
void take(const SceneValue& value, bool& to);
void take(const SceneValue& value, int& to);
void take(const SceneValue& value, std::int64_t& to);
void take(const SceneValue& value, double& to);
void take(const SceneValue& value, float& to);
void take(const SceneValue& value, Vec3d& to);
void take(const SceneValue& value, Vec3f& to);
void take(const SceneValue& value, std::string& to);
/// Two numbers.
void take(const SceneValue& value, std::optional<std::array<double, 2>>& to);

/// Without a default of its own in the schema: rules supply it, or the struct has what its absence means.
template <class S, class T>
KeyRow<S> key_row_if_given(T S::*member, KeySpec key) {
    return {std::move(key), [member](const SceneValue& value, S& to) { take(value, to.*member); }};
}

/// The default is the struct's, unless the key says another or is required.
template <class S, class T>
KeyRow<S> key_row(T S::*member, KeySpec key) {
    if (!key.required && !key.fallback) key.fallback = value_of(S{}.*member);
    return key_row_if_given(member, std::move(key));
}

/// One of some words.
template <class S, class E, std::size_t n>
KeyRow<S> word_row_if_given(E S::*member, const Word<E> (&words)[n], std::string name, std::string doc) {
    return {choice_key(std::move(name), names_of(words), std::move(doc)),
            [member, &words](const SceneValue& value, S& to) {
                to.*member = value_named(words, std::get<std::string>(value.data));
            }};
}
template <class S, class E, std::size_t n>
KeyRow<S> word_row(E S::*member, const Word<E> (&words)[n], std::string name, std::string doc) {
    KeyRow<S> row = word_row_if_given(member, words, std::move(name), std::move(doc));
    row.key.fallback = value_of(name_of(words, S{}.*member));
    return row;
}

/// A count for which a word may stand, which the member holds as `meaning`.
template <class S>
KeyRow<S> count_or_word_row(int S::*member, const char* word, int meaning, KeySpec key) {
    key.word = word;
    return {std::move(key), [member, meaning](const SceneValue& value, S& to) {
                if (std::holds_alternative<std::string>(value.data)) {
                    to.*member = meaning;
                } else {
                    take(value, to.*member);
                }
            }};
}

/// Rows of a part as rows of the whole.
template <class S, class Part>
KeyRows<S> rows_within(Part S::*part, const KeyRows<Part>& rows) {
    KeyRows<S> all;
    for (const KeyRow<Part>& row : rows) {
        std::function<void(const SceneValue&, S&)> read;
        if (row.read) read = [part, own = row.read](const SceneValue& value, S& to) { own(value, to.*part); };
        all.push_back({row.key, std::move(read)});
    }
    return all;
}

template <class T>
std::vector<T> operator+(std::vector<T> a, std::vector<T> b) {
    for (T& row : b)
        a.push_back(std::move(row));
    return a;
}

}  // namespace obscura
