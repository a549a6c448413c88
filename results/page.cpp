// index.html of a run: one file, no network, plots drawn by a small script of our own (page.html).
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_text.hpp"
#include "results/folder.hpp"
#include "results/page_text.hpp"

namespace whirl::results {
namespace {

using nlohmann::ordered_json;

// Four digits are finer than a pixel.
ordered_json rounded(double x) {
  if (!std::isfinite(x)) return nullptr;
  char text[32];
  const char* end = std::to_chars(text, text + sizeof text, x, std::chars_format::general, 4).ptr;
  double shown = 0.0;
  std::from_chars(text, end, shown);
  return shown;
}

ordered_json curve(const Curves& curves, std::size_t column) {
  const Curves::Curve& c = curves.curve(column);
  ordered_json out;
  out["name"] = curves.columns()[column].name;
  out["unit"] = curves.columns()[column].unit;
  if (c.constant) {
    out["constant"] = c.low.empty() ? ordered_json(nullptr) : rounded(c.low[0]);
    return out;
  }
  out["stride"] = curves.stride();
  out["low"] = out["high"] = ordered_json::array();
  for (const double x : c.low) out["low"].push_back(rounded(x));
  for (const double x : c.high) out["high"].push_back(rounded(x));
  return out;
}

// Deepest use of each stack, from the board's own words: main first, then those of an RTOS's tasks.
ordered_json stacks_of(const ordered_json& board) {
  ordered_json stacks = ordered_json::array();
  if (!board.is_object() || !board.contains("stack_used_bytes")) return stacks;
  stacks.push_back({{"stack", "main"}, {"used_bytes", board["stack_used_bytes"]}});
  for (const auto& task : board.value("task_stacks", ordered_json::array())) stacks.push_back(task);
  return stacks;
}

// How long the core may have waited for DMA, which no time counts; 0: not said.
double dma_wait_s(const ordered_json& board) {
  if (!board.is_object() || !board.contains("core_waits_for_dma_at_most_ns")) return 0.0;
  const auto& wait = board["core_waits_for_dma_at_most_ns"];
  return wait.is_number() ? wait.get<double>() * 1e-9 : 0.0;
}

}  // namespace

std::string page_html(const Report& report, const Curves& curves) {
  auto data = parse_ordered_json(run_json(report));
  data["stacks"] = stacks_of(data["board"]);
  data["watched"] = data["board"].is_object()
                        ? data["board"].value("watched", ordered_json::array())
                        : ordered_json::array();
  data["dma_wait_at_most_s"] = dma_wait_s(data["board"]);
  data.erase("board");
  data["step_s"] = static_cast<double>(curves.step_ns()) * 1e-9;
  data["signals"] = ordered_json::array();
  for (std::size_t i = 0; i < curves.columns().size(); ++i) {
    data["signals"].push_back(curve(curves, i));
  }
  return fill_page(kRunPage, text_of(data));
}

}  // namespace whirl::results
