#include "io_bridges/openocd/core_probe.hpp"

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <tuple>

namespace whirl::openocd {
namespace {

constexpr int kFlash_ms = 60'000;
constexpr std::uint32_t kTrace_enable = 1u << 24;  // DEMCR.TRCENA

std::string hex_of(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%08X", value);
  return text;
}

Error unclear(const std::string& command, const std::string& answer) {
  return {ErrorKind::host, "openocd", "answers '" + answer.substr(0, 60) + "' to " + command, ""};
}

bool parse_word(const std::string& text, std::uint32_t& word) {
  char* end = nullptr;
  const unsigned long long value = std::strtoull(text.c_str(), &end, 0);
  word = static_cast<std::uint32_t>(value);
  return end != text.c_str() && *end == '\0' && value <= 0xFFFF'FFFFull;
}

}  // namespace

Result<Done> CoreProbe::flash(const std::string& elf) {
  const auto done = client_.ask("program {" + elf + "} verify reset", kFlash_ms);
  if (!done) return done.error();
  return Done{};
}

Result<Done> CoreProbe::reset() {
  const auto done = client_.ask("reset run");
  if (!done) return done.error();
  return Done{};
}

Result<std::vector<std::uint32_t>> CoreProbe::read_words(std::uint32_t address, int count) {
  const std::string command = "read_memory " + hex_of(address) + " 32 " + std::to_string(count);
  const auto answer = client_.ask(command);
  if (!answer) return answer.error();
  std::vector<std::uint32_t> words;
  std::istringstream text(answer.value());
  for (std::string one; text >> one;) {
    std::uint32_t word = 0;
    if (!parse_word(one, word)) return unclear(command, answer.value());
    words.push_back(word);
  }
  if (words.size() != static_cast<std::size_t>(count)) return unclear(command, answer.value());
  return words;
}

// "pc 0x08000123", as get_reg answers.
Result<std::uint32_t> CoreProbe::read_register(const std::string& name) {
  const auto answer = client_.ask("get_reg " + name);
  if (!answer) return answer.error();
  std::istringstream text(answer.value());
  std::string said, value;
  std::uint32_t word = 0;
  text >> said >> value;
  if (said != name || !parse_word(value, word)) return unclear("get_reg " + name, answer.value());
  return word;
}

Result<CoreState> CoreProbe::look() {
  if (const auto halted = client_.ask("halt"); !halted) return halted.error();
  const auto read = [this]() -> Result<CoreState> {
    CoreState s;
    for (const auto& [name, into] :
         {std::pair{"pc", &s.pc}, {"lr", &s.lr}, {"sp", &s.sp}, {"xPSR", &s.xpsr}}) {
      const auto value = read_register(name);
      if (!value) return value.error();
      *into = value.value();
    }
    s.exception = s.xpsr & 0x1FF;
    const auto faults = read_words(kCfsr, 5);  // CFSR, HFSR, DFSR, MMFAR, BFAR
    if (!faults) return faults.error();
    s.cfsr = faults.value()[0];
    s.hfsr = faults.value()[1];
    s.mmfar = faults.value()[3];
    s.bfar = faults.value()[4];
    if (s.exception == 0) return s;
    // EXC_RETURN bit 2: the frame is on the process stack. A handler that has called on keeps no EXC_RETURN in LR.
    const bool on_process = s.lr >= 0xFFFF'FFE0 && (s.lr & 4) != 0;
    const auto frame_at = on_process ? read_register("psp") : Result<std::uint32_t>(s.sp);
    if (!frame_at) return frame_at.error();
    const auto frame = read_words(frame_at.value(), 8);
    if (!frame) return frame.error();
    std::copy(frame.value().begin(), frame.value().end(), s.stacked.begin());
    return s;
  };
  const auto state = read();
  const auto resumed = client_.ask("resume");
  if (!state) return state.error();
  if (!resumed) return resumed.error();
  return state;
}

Result<Done> CoreProbe::start_sampling() {
  const auto demcr = read_words(kDemcr, 1);
  if (!demcr) return demcr.error();
  const auto done = client_.ask("write_memory " + hex_of(kDemcr) + " 32 " +
                                hex_of(demcr.value()[0] | kTrace_enable));
  if (!done) return done.error();
  return Done{};
}

Result<std::uint32_t> CoreProbe::sample_pc() {
  const auto word = read_words(kPcsr, 1);
  if (!word) return word.error();
  return word.value()[0];
}

}  // namespace whirl::openocd
