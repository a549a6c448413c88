// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/system_control.hpp"

#include <utility>

namespace whirl::qemu {
namespace {

// Offsets from 0xE000E000, ARMv7-M ARM B3.2.2.
constexpr std::uint32_t kBase = 0xE000E000;
constexpr std::uint32_t kSysTick = 0x010, kSysTick_end = 0x020;
constexpr std::uint32_t kIpr = 0x400, kIpr_end = 0x4F0;
constexpr std::uint32_t kAircr = 0xD0C, kScr = 0xD10, kShpr = 0xD18, kShpr_end = 0xD24;
constexpr std::uint32_t kSleep_on_exit = 1u << 1, kSend_event = 1u << 4;
constexpr std::uint32_t kDemcr = 0xDFC;
constexpr std::uint32_t kTrcena = 1u << 24;
constexpr std::uint32_t kVectKey = 0x05FA, kSysResetReq = 1u << 2;
constexpr std::uint32_t kStoredZero = 0x0F0F0F0Fu;

bool is_priority(std::uint32_t offset) {
  return (offset >= kIpr && offset < kIpr_end) || (offset >= kShpr && offset < kShpr_end);
}

unsigned memory_op(unsigned size) {
  return size == 4 ? 2u : size == 2 ? 1u : 0u;
}

}  // namespace

SystemControl::SystemControl(const Api& api, board::Board& board, MemoryRegion* nvic,
                             std::function<void()> reset_request,
                             std::function<void(std::uint32_t address)> accessed)
    : api_(api),
      board_(board),
      nvic_(nvic),
      reset_request_(std::move(reset_request)),
      accessed_(std::move(accessed)) {}

void SystemControl::map(MemoryRegion* parent, MemoryRegion& region) {
  static const RegionOps kOps = {
      nullptr, nullptr, read_hook, write_hook, kLittleEndian, {1, 4, true, nullptr}, {1, 4, true}};
  api_.memory_region_init_io(&region, nullptr, &kOps, this, "whirl.scs", 0x1000);
  api_.memory_region_add_subregion_overlap(parent, kBase, &region, 20);
}

std::uint32_t SystemControl::read_hook(void* self, hwaddr offset, std::uint64_t* value,
                                       unsigned size, Attributes attributes) {
  return static_cast<SystemControl*>(self)->read(static_cast<std::uint32_t>(offset), *value, size,
                                                 attributes);
}

std::uint32_t SystemControl::write_hook(void* self, hwaddr offset, std::uint64_t value,
                                        unsigned size, Attributes attributes) {
  return static_cast<SystemControl*>(self)->write(static_cast<std::uint32_t>(offset), value, size,
                                                  attributes);
}

std::uint32_t SystemControl::read(std::uint32_t offset, std::uint64_t& value, unsigned size,
                                  Attributes attributes) {
  accessed_(kBase + offset);
  if (offset >= kSysTick && offset < kSysTick_end) {
    value = board_.systick().read(offset - kSysTick, size);
    return kOk;
  }
  if (offset == kDemcr) {
    value = demcr_;
    return kOk;
  }
  if (offset == kScr) {  // QEMU keeps none of its bits
    value = scr_;
    return kOk;
  }
  const std::uint32_t result =
      api_.memory_region_dispatch_read(nvic_, offset, &value, memory_op(size), attributes);
  if (is_priority(offset)) value &= 0xF0F0F0F0u;
  return result;
}

std::uint32_t SystemControl::write(std::uint32_t offset, std::uint64_t value, unsigned size,
                                   Attributes attributes) {
  accessed_(kBase + offset);
  if (offset >= kSysTick && offset < kSysTick_end) {
    board_.systick().write(offset - kSysTick, static_cast<std::uint32_t>(value), size);
    return kOk;
  }
  if (offset == kDemcr) {
    demcr_ = static_cast<std::uint32_t>(value);
    board_.cycle_counter().set_trace_enabled((demcr_ & kTrcena) != 0);
    return kOk;
  }
  if (offset == kScr) {
    scr_ = static_cast<std::uint32_t>(value) & (kSleep_on_exit | kSleep_deep | kSend_event);
    if ((scr_ & kSleep_on_exit) != 0) {
      report_once(on_exit_reported_, board_.events().now(),
                  "SLEEPONEXIT is set: not modelled, handlers return to thread mode");
    }
    return kOk;
  }
  if (offset == kAircr && size == 4 && (value >> 16) == kVectKey && (value & kSysResetReq) != 0) {
    reset_request_();
    return kOk;
  }
  if (is_priority(offset)) value |= kStoredZero;
  return api_.memory_region_dispatch_write(nvic_, offset, value, memory_op(size), attributes);
}

void SystemControl::report_deep_sleep(io::Nanoseconds now) {
  report_once(deep_reported_, now,
              "WFI with SLEEPDEEP set: Stop and Standby are not modelled, the core just sleeps");
}

void SystemControl::report_once(bool& reported, io::Nanoseconds now, const char* what) {
  if (std::exchange(reported, true)) return;
  board_.report({now, "core", what});
}

std::uint32_t SystemControl::word(std::uint32_t offset) {
  std::uint64_t value = 0;
  api_.memory_region_dispatch_read(nvic_, offset, &value, kWord, kPrivileged);
  return static_cast<std::uint32_t>(value);
}

void SystemControl::core_was_reset() {
  const auto clear = [this](std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t at = from; at < to; at += 4) {
      api_.memory_region_dispatch_write(nvic_, at, kStoredZero, kWord, kPrivileged);
    }
  };
  clear(kIpr, kIpr_end);
  clear(kShpr, kShpr_end);
  demcr_ = scr_ = 0;
}

}  // namespace whirl::qemu
