// All texts of a JSON value as legal_text (base/text.hpp) has them, so that it can be written.
#pragma once
#include <nlohmann/json.hpp>

#include "base/text.hpp"

namespace whirl::results {

inline void make_legal(nlohmann::ordered_json& value) {
  if (value.is_string()) value = legal_text(value.get_ref<const std::string&>());
  if (!value.is_structured()) return;
  for (auto& inner : value) make_legal(inner);
}

}  // namespace whirl::results
