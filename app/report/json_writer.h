#pragma once
// JSON out of values in order (RFC 8259): numbers in their shortest exact form, text escaped. Written for
// machine reports; reading JSON is nobody's business here.

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

class JsonWriter {
  public:
    JsonWriter& begin_object();
    JsonWriter& end_object();
    JsonWriter& begin_list();
    JsonWriter& end_list();
    JsonWriter& key(std::string_view name);
    JsonWriter& value(std::string_view text);
    JsonWriter& value(const char* text) { return value(std::string_view(text)); }
    JsonWriter& value(double number);  ///< null when not finite: JSON has no such number
    JsonWriter& value(bool truth);
    template <std::integral T>
    requires(!std::same_as<T, bool>) JsonWriter& value(T number) { return literal(std::to_string(number)); }
    template <class T>
    JsonWriter& member(std::string_view name, const T& v) {
        return key(name).value(v);
    }

    /// The document. Every list and object must be closed.
    std::string finish() const;

  private:
    JsonWriter& literal(std::string_view text);
    JsonWriter& open(char bracket);
    JsonWriter& close(char bracket);
    void separate();

    std::string out;
    std::vector<bool> empty;  ///< per open list or object: nothing in it yet
    bool after_key = false;
};

}  // namespace obscura
