// JSON from text and to text, compiled once: in each file of its own these two cost seconds of a build.
//
//   Parsed   bad text: an object that is_discarded(); nothing is thrown
//   Written  strings that are no UTF-8 throw nlohmann's type_error, or with `replace` become U+FFFD;
//            indent -1: all on one line
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace whirl {

enum class NoUtf8 { refuse, replace };

nlohmann::json parse_json(std::string_view text);
nlohmann::ordered_json parse_ordered_json(std::string_view text);
std::string text_of(const nlohmann::json& value, int indent = -1, NoUtf8 bad = NoUtf8::refuse);
std::string text_of(const nlohmann::ordered_json& value, int indent = -1);

}  // namespace whirl
