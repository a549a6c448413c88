#include "base/json_text.hpp"

#include <nlohmann/json.hpp>

namespace whirl {

nlohmann::json parse_json(std::string_view text) {
  return nlohmann::json::parse(text, nullptr, false);
}

nlohmann::ordered_json parse_ordered_json(std::string_view text) {
  return nlohmann::ordered_json::parse(text, nullptr, false);
}

std::string text_of(const nlohmann::json& value, int indent, NoUtf8 bad) {
  using Handler = nlohmann::json::error_handler_t;
  return value.dump(indent, ' ', false,
                    bad == NoUtf8::replace ? Handler::replace : Handler::strict);
}

std::string text_of(const nlohmann::ordered_json& value, int indent) {
  return value.dump(indent);
}

}  // namespace whirl
