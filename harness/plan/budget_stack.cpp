#include "harness/plan/budget_stack.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/json_text.hpp"

namespace whirl::plan {
namespace {

struct Depth {
  double bytes = std::nan("");
  std::string why;  // it is not known
};

// What the board says at its end. It counts 0 bytes where the image's initial stack pointer is in no memory.
Depth depth_of(const std::string& statistics, const std::string& of) {
  const auto board = parse_json(statistics);
  if (!board.is_object()) return {.why = "the board did not tell how deep its stacks went"};
  const nlohmann::json* used = nullptr;
  if (of.empty()) {
    if (board.contains("stack_used_bytes")) used = &board["stack_used_bytes"];
  } else if (board.contains("task_stacks") && board["task_stacks"].is_array()) {
    for (const auto& task : board["task_stacks"]) {
      if (task.is_object() && task.value("stack", "") == of && task.contains("used_bytes"))
        used = &task["used_bytes"];
    }
    if (used == nullptr) return {.why = "no task was seen to run on a stack '" + of + "'"};
  }
  if (used == nullptr || !used->is_number_unsigned() || *used == 0u)
    return {.why = "the board did not tell how deep this stack went"};
  return {used->get<double>(), ""};
}

}  // namespace

StackBudget read_stack_budget(const lua::Table& given, std::size_t node, const std::string& name,
                              const std::string& place) {
  StackBudget budget;
  if (!given.has("depth")) return budget;
  const double bytes = given.quantity("depth", Dimension::data, lua::above(0.0));
  budget.depth = Limit{bytes, unit_symbol(given.text("depth"))};
  budget.margin = given.quantity_or("margin", Dimension::ratio, 0.0, lua::between(0.0, 0.9));
  if (given.has("of")) budget.of = given.text("of");
  if (given.has("during")) given.refuse("during", "a stack's depth is of the whole run");
  budget.name = name + (budget.of.empty() ? "" : " of " + budget.of) + " depth";
  budget.place = place;
  budget.node = node;
  return budget;
}

void judge_stack(Script& script, const StackBudget& budget, std::int64_t to_ns) {
  const Depth depth = depth_of(script.stage().logs[budget.node].statistics, budget.of);
  const Limit limit{budget.depth->value_SI * (1.0 - budget.margin), budget.depth->unit};
  std::string note = depth.why;
  if (note.empty()) {
    char text[96];
    std::snprintf(text, sizeof text, "%.0f B; %.3g %% of the limit left%s", depth.bytes,
                  100.0 * (1.0 - depth.bytes / budget.depth->value_SI),
                  budget.margin > 0.0 ? ", with the margin that was asked" : "");
    note = text;
  }
  script.judge_in_window({depth.bytes, Dimension::data, budget.name}, Script::Figure::extreme,
                         limit, budget.place, 1e-9 * static_cast<double>(to_ns), note);
}

}  // namespace whirl::plan
