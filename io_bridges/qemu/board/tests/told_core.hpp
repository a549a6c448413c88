// The watcher, told of a core's life by hand, and what it tells of it.
#pragma once
#include <utility>
#include <vector>

#include "io_bridges/qemu/board/watch.hpp"

namespace whirl::board {

inline constexpr std::uint32_t kMain = 0x20010000, kTask = 0x20004000, kOther = 0x20006000;
inline constexpr std::uint32_t kToThread = 0xFFFFFFFD, kToHandler = 0xFFFFFFF1;
inline constexpr std::uint32_t kFrame = 32, kCode = 0x08000100, kHandler = 0x08000800;

inline bool no_memory(std::uint32_t, void*, std::size_t) {
  return false;
}

// A core whose moves are spelled out: thread mode at a stack pointer, exceptions on top.
struct Core {
  CoreState thread(std::uint32_t sp, std::uint32_t lr = 0) const { return {now, 0, sp, lr, kCode}; }
  CoreState handler(std::uint32_t exception, std::uint32_t lr) const {
    return {now, exception, kMain, lr, kHandler};
  }
  void enter(std::uint32_t exception, std::uint32_t thread_sp) {
    watch.exception(thread(thread_sp), handler(exception, kToThread));
  }
  void nest(std::uint32_t below, std::uint32_t exception) {
    watch.exception(handler(below, kToThread), handler(exception, kToHandler));
  }
  CoreState returning(std::uint32_t exception) const {
    return {now, exception, kMain, kToThread, kToThread & ~1u};
  }
  void leave_to_thread(std::uint32_t exception, std::uint32_t sp) {
    watch.exception(returning(exception), thread(sp));
  }
  void leave_to(std::uint32_t exception, std::uint32_t below) {
    watch.exception(returning(exception), handler(below, kToThread));
  }
  void call(std::uint16_t number, std::uint32_t sp, std::uint32_t lr) {
    watch.enter_function(number, thread(sp, lr));
  }
  void come_back(std::uint32_t address, std::uint32_t sp) {
    watch.return_site(address, thread(sp));
  }
  std::vector<std::pair<int, Nanoseconds>> calls() const {  // number, execution
    std::vector<std::pair<int, Nanoseconds>> found;
    for (io::Reader r(happened.bytes()); r.next();) {
      if (r.header().kind != io::Kind::function_call) continue;
      found.emplace_back(r.header().port, r.as<io::FunctionCall>().execution_ns);
    }
    return found;
  }

  Nanoseconds now = 0;
  io::Batch happened;
  Watch watch{happened, no_memory};
};
using Calls = std::vector<std::pair<int, Nanoseconds>>;

struct Told {  // of a call, or of an interrupt's latency
  io::Kind kind{};
  int port = 0;
  Nanoseconds from = 0, until = 0, latency = -1;
  bool operator==(const Told&) const = default;
};
inline std::vector<Told> all_told(const Core& core) {
  std::vector<Told> all;
  for (io::Reader r(core.happened.bytes()); r.next();) {
    Told told{r.header().kind, r.header().port, 0, r.header().t_ns};
    if (told.kind == io::Kind::function_call) {
      told.from = r.as<io::FunctionCall>().entry_ns;
      told.latency = r.as<io::FunctionCall>().latency_ns;
    } else {
      told.from = r.as<io::InterruptLatency>().raised_ns;
    }
    all.push_back(told);
  }
  return all;
}
inline constexpr io::Kind kCall = io::Kind::function_call, kLatency = io::Kind::interrupt_latency;

}  // namespace whirl::board
