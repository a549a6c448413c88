// What a board tells of a whole run at its end, as JSON: how deep its stacks went, how long the core slept,
// what nobody answered, how long DMA may have held the core up, which calls were the longest.
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/json_text.hpp"
#include "base/text.hpp"
#include "io_bridges/qemu/board/board.hpp"
#include "io_bridges/qemu/board/post_mortem.hpp"

namespace whirl::board {
namespace {

constexpr std::uint32_t kSmallest_stack = 64;  // an exception's frame and a little
constexpr std::uint32_t kVtor = 0xD08;         // in SCS

nlohmann::json lines_of(const std::string& text) {
  nlohmann::json lines = nlohmann::json::array();
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace

// The array that a stack's top ends or lies in, or its address.
std::string Board::stack_name(std::uint32_t top) const {
  const Symbol* array = setup_.image.object_at(top - 1);
  if (array == nullptr) return hex(top);
  const std::uint32_t end = array->address + array->size;
  if (end - top < kSmallest_stack) return array->name;
  return array->name + " up to +" + std::to_string(top - array->address);
}

nlohmann::json Board::task_stacks() const {
  nlohmann::json list = nlohmann::json::array();
  for (const StackUse& stack : watch_.stacks().task_stacks()) {
    list.push_back({{"stack", stack_name(stack.top)},
                    {"top", hex(stack.top)},
                    {"used_bytes", stack.used_bytes}});
  }
  return list;
}

// As the vector table has it; empty: no function of the image.
std::string Board::handler_name(std::uint32_t exception) const {
  std::uint32_t handler = 0;
  const std::uint32_t vectors = emulator_.system_control_word(kVtor);
  if (!emulator_.peek(vectors + 4 * exception, &handler, sizeof handler)) return "";
  const Symbol* symbol = setup_.image.function_at(handler & ~1u);
  return symbol == nullptr ? "" : symbol->name;
}

std::string Board::exception_name(std::uint32_t exception) const {
  const std::string handler = handler_name(exception);
  return "exception " + std::to_string(exception) + (handler.empty() ? "" : " (" + handler + ")");
}

nlohmann::json Board::handlers() const {
  nlohmann::json names = nlohmann::json::object();
  for (std::uint32_t exception = 0; exception < Watch::kExceptions; ++exception) {
    if (watch_.was_taken(exception)) names[std::to_string(exception)] = handler_name(exception);
  }
  return names;
}

nlohmann::json Board::long_call(const LongCall& call) const {
  nlohmann::json between = nlohmann::json::array();
  for (const Between& one : call.between) {
    between.push_back({{"exception", exception_name(one.exception)},
                       {"times", one.times},
                       {"ran_ns", one.ran.ns},
                       {"ran_cycles", one.ran.cycles}});
  }
  return {{"entry_ns", call.entry_ns},
          {"execution_ns", call.execution.ns},
          {"execution_cycles", call.execution.cycles},
          {"response_ns", call.response.ns},
          {"response_cycles", call.response.cycles},
          {"in", call.exception == 0 ? "thread" : exception_name(call.exception)},
          {"path", lines_of(call.path)},
          {"exceptions", call.exceptions},
          {"between", between}};
}

nlohmann::json Board::watched_calls() const {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [number, worst] : watch_.worst_calls().by_number()) {
    list.push_back({{"name", setup_.description.watch[number]},
                    {"worst_execution", long_call(worst.execution)},
                    {"worst_response", long_call(worst.response)}});
  }
  return list;
}

void Board::add_statistics() {
  check_profile();
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [address, touch] : unanswered_.touched()) {
    list.push_back({{"address", hex(address)},
                    {"by", setup_.image.describe(touch.pc)},
                    {"t_ns", touch.t_ns},
                    {"read", touch.read},
                    {"written", touch.written},
                    {"times", touch.times}});
  }
  nlohmann::json statistics = {
      {"unanswered", list},
      {"stack_used_bytes", stack_used(*setup_.part, peek())},
      {"slept_ns", emulator_.slept_ns()},
      {"core_waits_for_dma_at_most_ns", std::llround(chip_->core_waits_for_dma_at_most_ns())},
      {"hse_start_ns", setup_.description.hse_start_ns},
      {"ns_per_instruction", setup_.description.ns_per_instruction}};
  if (watch_.stacks().count() > 1) statistics["task_stacks"] = task_stacks();
  statistics["watched"] = watched_calls();
  statistics["handlers"] = handlers();
  const std::string text = text_of(statistics);
  happened_.add(io::Kind::statistics, 0, events_.now(), text.data(),
                static_cast<std::uint32_t>(text.size()));
}

}  // namespace whirl::board
