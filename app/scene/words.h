#pragma once
// Enumerations by name: one row per value, for keys that choose it and for messages that tell it.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace obscura {

template <class E>
struct Word {
    const char* name;
    E value;
};

template <class E, std::size_t n>
std::vector<std::string> names_of(const Word<E> (&words)[n]) {
    std::vector<std::string> names;
    for (const Word<E>& word : words)
        names.emplace_back(word.name);
    return names;
}

template <class E, std::size_t n>
const char* name_of(const Word<E> (&words)[n], E value) {
    for (const Word<E>& word : words) {
        if (word.value == value) return word.name;
    }
    CHECK(false, "a value without a name");
    return "";
}

/// The value of a name that is one of the words.
template <class E, std::size_t n>
E value_named(const Word<E> (&words)[n], std::string_view name) {
    for (const Word<E>& word : words) {
        if (name == word.name) return word.value;
    }
    CHECK(false, std::string(name));
    return words[0].value;
}

}  // namespace obscura
