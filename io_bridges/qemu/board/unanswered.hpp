// The peripheral space that no model answers: reads 0, forgets writes, and remembers each address
// once, with the first that touched it. Silence is never an answer: the results list it.
#pragma once
#include <cstdint>
#include <functional>
#include <map>

#include "io_bridges/qemu/stm32/peripheral.hpp"

namespace whirl::board {

class Unanswered final : public stm32::Peripheral {
 public:
  struct Touch {
    std::uint32_t pc = 0;
    std::int64_t t_ns = 0;
    bool read = false, written = false;
    std::uint64_t times = 0;
  };
  // `first` is told of each address once.
  using First = std::function<void(std::uint32_t address, const Touch&)>;

  Unanswered(std::uint32_t base, std::function<std::uint32_t()> pc,
             std::function<std::int64_t()> now, First first)
      : base_(base), pc_(std::move(pc)), now_(std::move(now)), first_(std::move(first)) {}

  const char* name() const override { return "unanswered"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override {
    record(offset, size, true);
    return 0;
  }
  void write(std::uint32_t offset, std::uint32_t, unsigned size) override {
    record(offset, size, false);
  }
  void reset() override {}
  const std::map<std::uint32_t, Touch>& touched() const { return touched_; }

 private:
  void record(std::uint32_t offset, unsigned, bool read) {
    const std::uint32_t address = base_ + (offset & ~3u);
    Touch& touch = touched_[address];
    (read ? touch.read : touch.written) = true;
    if (touch.times++ != 0) return;
    touch.pc = pc_();
    touch.t_ns = now_();
    first_(address, touch);
  }

  std::uint32_t base_;
  std::function<std::uint32_t()> pc_;
  std::function<std::int64_t()> now_;
  First first_;
  std::map<std::uint32_t, Touch> touched_;
};

}  // namespace whirl::board
