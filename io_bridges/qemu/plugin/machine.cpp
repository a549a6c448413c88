// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/machine.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "io_bridges/qemu/plugin/cycle_clock.hpp"
#include "io_bridges/qemu/plugin/exception_hook.hpp"
#include "io_bridges/qemu/plugin/fixed_rate.hpp"

namespace whirl::qemu {
namespace {

constexpr int kSysTickException = 15;
constexpr int kCoreRegisters = 16, kSp = 13, kLr = 14, kPc = 15, kXpsr = 25;
constexpr std::uint32_t kFpccr = 0xF34;  // in the System Control Space
constexpr int kRounds = 64;  // of a sleep before other work of the CPU's thread gets a turn

}  // namespace

Machine::Machine(const Api& api, board::Setup setup, io::Channel channel)
    : api_(api), board_(std::move(setup), std::move(channel), *this) {
  const auto& description = board_.description();
  if (description.ns_per_instruction > 0) {
    clock_ = std::make_unique<FixedRate>(description.ns_per_instruction);
  } else {
    clock_ = std::make_unique<CycleClock>(
        api, board_.part().is_m4 ? cycles::Core::cortex_m4f : cycles::Core::cortex_m3,
        [this] { clock_not_as_known(); });
  }
}

void Machine::clock_not_as_known() {
  board_.refuse({ErrorKind::host, "QEMU", "it does not count its instructions as known",
                 std::string("use QEMU ") + tested_versions() +
                     ", or a board file with a fixed timing (timing = \"8 ns\")"});
}

Machine::~Machine() = default;

Result<Done> Machine::build(const std::string& versions) {
  bool ambiguous = false;
  Object* core = api_.object_resolve_path_type("", "armv7m", &ambiguous);
  if (core == nullptr || ambiguous) {
    return whirl::Error{ErrorKind::internal, "QEMU", "the machine has no ARMv7-M core", ""};
  }
  nvic_ = api_.object_resolve_path_component(core, "nvic");
  core_memory_ = reinterpret_cast<MemoryRegion*>(
      api_.object_resolve_path_component(core, "armv7m-container[0]"));
  Object* registers =
      nvic_ == nullptr ? nullptr : api_.object_resolve_path_component(nvic_, "nvic_sysregs[0]");
  if (core_memory_ == nullptr || registers == nullptr) {
    return whirl::Error{ErrorKind::internal, "QEMU", "the core has no NVIC where 7.2 has it", ""};
  }
  init_timers();  // a part may set its first event as it is made
  const auto devices = board_.build_devices();
  if (!devices) return devices.error();
  cpu_ = api_.qemu_get_cpu(0);
  for (int irq = 0; irq < board_.part().interrupts; ++irq) {
    interrupts_.push_back(api_.qdev_get_gpio_in(core, irq));
  }
  register_text_ = api_.g_byte_array_new();
  if (!find_registers()) {
    return whirl::Error{ErrorKind::internal, "QEMU", "the core's registers are not side by side",
                        ""};
  }
  if (auto found = clock_->find_qemu(); !found) return found;
  if (!exit_request_.find(api_, cpu_) || !class_casts_.find(api_, cpu_)) {
    return whirl::Error{ErrorKind::internal, "QEMU", "its CPU is not laid out as in 7.2", ""};
  }
  if (const auto hooked = hook_exceptions(api_, cpu_, [this] { take_exception(); }); !hooked) {
    return hooked.error();
  }
  system_control_ = std::make_unique<SystemControl>(
      api_, board_, reinterpret_cast<MemoryRegion*>(registers),
      [this] { reset_core(stm32::ResetCause::software); },
      [this](std::uint32_t address) { accessed(address); });
  map_memories();
  load_image();
  board_.power_on(versions);
  if (board_.run().gdb_port == 0) {
    parking_ = api_.qemu_bh_new_full(
        [](void* self) { static_cast<Machine*>(self)->park_main_loop(); }, this, "whirl", nullptr);
    api_.qemu_bh_schedule(parking_);
  }
  // QEMU resets the machine once more before it starts; the first thing that runs is this work.
  api_.async_run_on_cpu(
      cpu_,
      [](Cpu*, WorkData self) {
        static_cast<Machine*>(self.pointer)->system_control_->core_was_reset();
      },
      WorkData{.pointer = this});
  return Done{};
}

// Under gdb the main loop lives, and takes a core that gdb has stopped for one that sleeps: it would move
// the clock on to the next deadline at each stop. It leaves out timers that are marked as external.
void Machine::init_timers() {
  constexpr int kExternal = 1;  // QEMU_TIMER_ATTR_EXTERNAL
  const auto fire = [](void* self) { static_cast<Machine*>(self)->on_timer(); };
  const int marks = board_.run().gdb_port != 0 ? kExternal : 0;
  api_.timer_init_full(&timer_, nullptr, kVirtualClock, 1, marks, fire, this);
  api_.timer_init_full(&jump_, nullptr, kVirtualClock, 1, 0, fire, this);
}

void Machine::arm(io::Nanoseconds deadline) {
  if (accesses_ > 0) {
    wanted_ns_ = deadline;
    return;
  }
  if (deadline == armed_ns_) return;
  armed_ns_ = deadline;
  if (deadline == io::kNever) return api_.timer_del(&timer_);
  api_.timer_mod(&timer_, deadline);
}

// A register may set many events, and most accesses that set any set one that is due at once (a DMA's
// first item). What is due is done here, as it would be behind the instruction, at the same time of the
// guest: QEMU's timer would take a turn of its outer loop for it.
void Machine::end_access() {
  if (--accesses_ > 0) return;
  const io::Nanoseconds wanted = std::exchange(wanted_ns_, kNothing_wanted);
  if (wanted == kNothing_wanted) return;
  // gdb may look at registers of a world that stands still.
  const bool runs = board_.run().gdb_port == 0;
  if (runs && board_.events().next_deadline() <= now()) return run_what_is_due();
  arm(wanted);
}

void Machine::set_interrupt(int irq, bool level) {
  act_or_defer({Deferred::interrupt, irq, level, {}});
}

void Machine::pend_systick() {
  act_or_defer({Deferred::systick, 0, true, {}});
}

void Machine::reset_core(stm32::ResetCause cause) {
  act_or_defer({Deferred::reset, 0, true, cause});
}

void Machine::queue_reset(stm32::ResetCause cause) {
  queued_resets_.push_back(cause);
  api_.async_run_on_cpu(
      cpu_,
      [](Cpu*, WorkData data) {
        Machine& self = *static_cast<Machine*>(data.pointer);
        const stm32::ResetCause why = self.queued_resets_.front();
        self.queued_resets_.pop_front();
        self.class_casts_.restore();
        self.api_.qemu_devices_reset(kGuestReset);
        self.system_control_->core_was_reset();
        self.board_.core_was_reset(why);
      },
      WorkData{.pointer = this});
}

bool Machine::peek(std::uint32_t address, void* to, std::size_t size) {
  AddressSpace* space = api_.cpu_get_address_space(cpu_, 0);
  return api_.address_space_rw(space, address, kPrivileged, to, size, false) == kOk;
}

std::uint32_t Machine::system_control_word(std::uint32_t offset) {
  return system_control_->word(offset);
}

void Machine::write_cells(std::uint32_t address, const void* from, std::size_t size) {
  api_.address_space_write_rom(api_.address_space_memory, address, kPrivileged, from, size);
}

std::uint32_t Machine::core_register(int number) const {
  if (number < kCoreRegisters) return core_registers_[number];
  api_.g_byte_array_set_size(register_text_, 0);
  if (api_.arm_cpu_gdb_read_register(cpu_, register_text_, number) != 4) return 0;
  std::uint32_t value = 0;
  std::memcpy(&value, register_text_->data, sizeof value);
  return value;
}

board::CoreState Machine::core_at(const Moment& moment) const {
  return {moment.now,         core_register(kXpsr), core_register(kSp),
          core_register(kLr), core_register(kPc),   moment.cycles};
}

// Between two instructions, with all registers in place and QEMU's clock readable.
void Machine::take_exception() {
  anchor();
  const board::CoreState before = core_at(clock_->moment());
  const auto fpccr = [this] { return system_control_->word(kFpccr); };
  const bool leaves = before.leaves_exception();
  std::uint32_t floating = leaves && board::has_floating_frame(before.pc) ? fpccr() : 0;
  api_.arm_v7m_cpu_do_interrupt(cpu_);
  board::CoreState after = core_at({before.now, before.cycles});
  if (!leaves && board::has_floating_frame(after.lr)) floating = fpccr();
  clock_->exception(before, after, floating);
  const Moment now = clock_->moment();
  after.now = now.now;
  after.cycles = now.cycles;
  board_.exception(before, after, [this](int number) { return core_register(number); });
}

// QEMU's CPU keeps R0 to R15 side by side. Where, is found by writing a pattern the official way.
bool Machine::find_registers() {
  constexpr int kMarked = 13;
  std::array<std::uint32_t, kMarked> pattern{};
  for (int i = 0; i < kMarked; ++i) {
    pattern[i] = 0x5A17C0DEu + static_cast<std::uint32_t>(i) * 0x01010101u;
    api_.arm_cpu_gdb_write_register(cpu_, reinterpret_cast<std::uint8_t*>(&pattern[i]), i);
  }
  const std::size_t size = api_.object_type_get_instance_size(api_.object_get_typename(cpu_));
  const auto* first = reinterpret_cast<const std::uint32_t*>(cpu_);
  const auto* last = first + size / sizeof *first;
  const auto* found = std::search(first, last, pattern.begin(), pattern.end());
  std::uint32_t zero = 0;
  for (int i = 0; i < kMarked; ++i) {
    api_.arm_cpu_gdb_write_register(cpu_, reinterpret_cast<std::uint8_t*>(&zero), i);
  }
  core_registers_ = found == last ? nullptr : found;
  return core_registers_ != nullptr;
}

io::Nanoseconds Machine::slept_ns() const {
  return slept_ns_ + (asleep_since_ns_ < 0 ? 0 : now() - asleep_since_ns_);
}

void Machine::on_timer() {
  armed_ns_ = io::kNever;
  run_what_is_due();
  run_at_once();
}

void Machine::run_what_is_due() {
  anchor();
  if (asleep_since_ns_ < 0) act_on_deferred();  // what hold() left
  board_.on_timer();
}

// QEMU's loop looks at the deadlines before it runs the core, whatever has changed them just now.
void Machine::run_at_once() {
  if (board_.run().gdb_port == 0) exit_request_.drop();
}

std::uint32_t Machine::accessing_pc() const {
  return core_register(kPc);
}

void Machine::core_stopped(board::StoppedCore why) {
  board_.core_stopped(why, clock_->core_now(),
                      [this](int number) { return core_register(number); });
}

void Machine::end() {
  _exit(0);
}

void Machine::park_main_loop() {
  if (!api_.runstate_is_running()) return api_.qemu_bh_schedule(parking_);  // still setting up
  // A loop that found this bottom half due before it polled has left word that it polls, and every change
  // of a timer would write to its eventfd to wake it. What it does after a poll takes the word back.
  for (AioContext* context : {api_.qemu_get_aio_context(), api_.iohandler_get_aio_context()}) {
    GlibSource* source = api_.aio_get_g_source(context);
    source->functions->check(source);
  }
  api_.qemu_mutex_unlock_iothread();
  for (;;) pause();  // the process ends by end(), or by the harness
}

// Exact sleep. With -icount QEMU's main loop may move the clock on as soon as the CPU has halted,
// that is, before the last few instructions have been accounted: about one sleep in 50,000 is then
// off by some instructions, depending on the host. Work queued before the halt keeps the CPU "not
// idle" until all is accounted; the work itself then runs the board's events in the CPU's thread.
// QEMU's clock stays behind meanwhile (moving it costs more than most events) and catches up before
// anything reaches the core: interrupt lines and resets wait in `deferred_` until then.
void Machine::before_sleep(std::int64_t site) {
  if (system_control_->sleeps_deeply()) {
    system_control_->report_deep_sleep(clock_->at(site).now);
  }
  work_before_sleep();
}

void Machine::work_before_sleep() {
  api_.async_run_on_cpu(
      cpu_, [](Cpu*, WorkData self) { static_cast<Machine*>(self.pointer)->sleep(); },
      WorkData{.pointer = this});
}

void Machine::sleep() {
  if (!api_.cpu_thread_is_idle(cpu_)) return;  // something was pending: the core did not sleep
  io::EventQueue& events = board_.events();
  // The core has run: QEMU has done with the reset of its machine.
  if (board_.run().gdb_port == 0) class_casts_.lighten();
  asleep_since_ns_ = sleep_now_ns_ = api_.qemu_clock_get_ns(kVirtualClock);
  bool idle = true;
  for (int round = 0; round < kRounds && idle; ++round) {
    sleep_now_ns_ = std::max(sleep_now_ns_, events.next_deadline());
    WHIRL_CHECK(sleep_now_ns_ != io::kNever);  // the next boundary is always there
    events.run_until(sleep_now_ns_);
    if (deferred_.empty() && board_.run().gdb_port == 0) continue;  // nothing has reached the core
    if (!deferred_.empty() && !catch_up()) return hold();
    idle = api_.cpu_thread_is_idle(cpu_);
  }
  if (!catch_up()) return hold();
  wake();
  // Idle still: other work of this thread gets a turn, then the sleep goes on.
  if (api_.cpu_thread_is_idle(cpu_)) {
    work_before_sleep();
  } else {
    arm(events.next_deadline());
  }
  run_at_once();
  if (board_.run().gdb_port != 0) give_way();
}

// Under gdb the main loop lives; a core that sleeps much would hardly let it have the lock. It cannot
// move the clock here: the CPU is not idle, there is an interrupt or work for it.
void Machine::give_way() {
  const auto now = std::chrono::steady_clock::now();
  if (now - gave_way_ < std::chrono::milliseconds(5)) return;
  api_.qemu_mutex_unlock_iothread();
  usleep(200);
  api_.qemu_mutex_lock_iothread_impl(__FILE__, __LINE__);
  gave_way_ = now;
}

// QEMU's clock to the board's, then what waited for it. On an idle CPU arming a timer moves the clock
// to its deadline at once.
// False: gdb is stopping the machine at this moment, and a stopped clock does not move.
bool Machine::catch_up() {
  if (api_.qemu_clock_get_ns(kVirtualClock) != sleep_now_ns_) {
    arm(io::kNever);  // the clock moves for the first timer only
    api_.timer_mod(&jump_, sleep_now_ns_);
    const std::int64_t there = api_.qemu_clock_get_ns(kVirtualClock);
    if (there < sleep_now_ns_ && board_.run().gdb_port != 0) return false;
    WHIRL_CHECK(there == sleep_now_ns_, there, sleep_now_ns_);
    api_.timer_del(&jump_);
  }
  act_on_deferred();
  return true;
}

// `jump_` is set to where the board is already; when gdb lets go it fires, and the rest follows.
void Machine::hold() {
  wake();
}

void Machine::wake() {
  slept_ns_ += clock_->slept(asleep_since_ns_, sleep_now_ns_);
  asleep_since_ns_ = -1;
}

void Machine::retime(const board::CoreTiming& timing) {
  if (clock_->retime(timing)) throw_code_away();
}

void Machine::act_on_deferred() {
  const std::vector<Deferred> waiting = std::exchange(deferred_, {});
  for (const Deferred& what : waiting) act(what);
}

void Machine::act(const Deferred& what) {
  switch (what.kind) {
    case Deferred::interrupt:
      return api_.qemu_set_irq(interrupts_[static_cast<std::size_t>(what.irq)], what.level ? 1 : 0);
    case Deferred::systick:
      return api_.armv7m_nvic_set_pending(nvic_, kSysTickException, false);
    case Deferred::reset:
      return queue_reset(what.cause);
  }
}

void Machine::act_or_defer(const Deferred& what) {
  if (asleep_since_ns_ < 0) return act(what);
  deferred_.push_back(what);
}

}  // namespace whirl::qemu
