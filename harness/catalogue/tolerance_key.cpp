#include "harness/catalogue/tolerance_key.hpp"

namespace whirl::catalogue {

using plant::ToleranceClass;

plant::Tolerances read_tolerance(const lua::Table& t, std::span<const char* const> groups,
                                 ToleranceClass unsaid) {
  plant::Tolerances all;
  if (!t.has("tolerance")) {
    if (unsaid == ToleranceClass::none) return all;
    for (const char* group : groups) all[group] = unsaid;
    return all;
  }
  const auto chosen = [](const lua::Table& in, const char* key) {
    const auto words = {plant::name(ToleranceClass::none), plant::name(ToleranceClass::typical),
                        plant::name(ToleranceClass::worst)};
    return plant::tolerance_named(in.choice(key, {words.begin(), words.end()}))
        .value_or(ToleranceClass::none);
  };
  const bool by_group = t.kind("tolerance") == lua::Kind::table;
  const lua::Table table = by_group ? t.table("tolerance") : t;
  const char* const for_rest = by_group ? "rest" : "tolerance";
  const auto rest = table.has(for_rest) ? chosen(table, for_rest) : ToleranceClass::none;
  for (const char* group : groups) {
    all[group] = by_group && table.has(group) ? chosen(table, group) : rest;
  }
  return all;
}

}  // namespace whirl::catalogue
