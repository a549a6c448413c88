#include "io_bridges/qemu/board/board.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <tuple>

#include "base/text.hpp"
#include "io_bridges/board_description/bus_name.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/qemu/board/chip_factory.hpp"
#include "io_bridges/qemu/board/post_mortem.hpp"
#include "io_bridges/qemu/stm32/adc.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/rack/tell_finding.hpp"

namespace whirl::board {
namespace {

constexpr std::uint32_t kPeripherals = 0x40000000, kPeripherals_size = 0x20000000;
constexpr double kLeastCycles = 0.8, kMostCycles = 3.0;  // per instruction, of a Cortex-M4
constexpr Nanoseconds kSettled_ns = 100'000'000;         // a clock that stays so long is meant
constexpr std::uint32_t kPage = 0x1000;
constexpr std::uint32_t kSysTickException = 15, kFirstInterrupt = 16;
constexpr std::uint32_t kHardFault = 3, kUsageFault = 6;
constexpr std::uint32_t kCfsr = 0xD28, kHfsr = 0xD2C, kMmfar = 0xD34, kBfar = 0xD38;  // in SCS

}  // namespace

Board::Board(Setup setup, io::Channel channel, Emulator& emulator)
    : setup_(std::move(setup)),
      channel_(std::move(channel)),
      emulator_(emulator),
      watch_(happened_, peek(),
             [this](std::uint32_t address, const CoreState& core) {
               return call_path(setup_.image, peek(), address, core.sp, core.exception() != 0);
             }),
      chip_(make_chip(
          *setup_.part,
          {events_, *this, *this, *this, [this](const io::Finding& f) { report(f); },
           setup_.description.hse_Hz, setup_.description.lse_Hz, setup_.description.hse_start_ns,
           setup_.description.hsi_error, setup_.description.hse_error})),
      wires_({events_, [this](const io::Finding& f) { report(f); },
              [this] { finish(io::BoardState::ended); }}),
      devices_({events_, *chip_, happened_, [this](const io::Finding& f) { report(f); },
                setup_.run.seed, rack::device_types(), setup_.run.folder, setup_.run.node, &wires_,
                setup_.run.wires}),
      core_faults_(
          {events_, emulator, happened_, setup_.image, setup_.description.watch,
           setup_.description.start != 0 ? setup_.description.start : setup_.part->flash.base,
           [this](double volts) { chip_->set_vdd(volts); }}),
      systick_(
          events_, chip_->clocks(), [this] { return emulator_.ahead_ns(); },
          [this] {
            watch_.line_changed(kSysTickException, true, events_.now());
            emulator_.pend_systick();
          }),
      cycle_counter_([this] { return emulator_.core_cycles(); }),
      unanswered_(
          kPeripherals, [this] { return emulator_.accessing_pc(); },
          [this] { return events_.now(); },
          [this](std::uint32_t address, const Unanswered::Touch& touch) {
            report({touch.t_ns, "board",
                    "no model answers at " + hex(address) + (touch.read ? ", read" : ", written") +
                        " by " + setup_.image.describe(touch.pc) + " (" + hex(touch.pc) + ")"});
          }),
      itm_("ITM", 0),
      flash_patch_("FPB", 0),
      tpiu_("TPIU", 0),
      etm_("ETM", 0),
      debug_mcu_("DBGMCU", setup_.part->idcode),
      boundary_(
          events_, [this] { synchronise(); }, io::Rank::boundary),
      profile_(events_, [this] { check_profile(); }) {
  events_.set_clock([this] { return emulator_.now(); });
  events_.set_rearm([this](Nanoseconds deadline) { emulator_.arm(deadline); });
  chip_->on_clock_change([this] {
    retime();
    systick_.clocks_changed();
  });
  chip_->on_flash_timing_change([this] { retime(); });
  chip_->on_reset_request([this](stm32::ResetCause cause) { emulator_.reset_core(cause); });
}

Board::~Board() = default;

Peek Board::peek() const {
  return [this](std::uint32_t address, void* to, std::size_t size) {
    return emulator_.peek(address, to, size);
  };
}

Result<Done> Board::build_devices() {
  if (const auto built = devices_.build(setup_.description); !built) return built.error();
  if (const auto followed = follow_wires(); !followed) return followed.error();
  return watch_converters();
}

Result<Done> Board::follow_wires() {
  for (const WireEnd& end : setup_.run.wires) {
    if (!end.device.empty()) continue;  // led by the rack, in place of that device
    if (auto followed = devices_.follow(end); !followed) return followed.error();
  }
  return Done{};
}

// "adc1" in the watch list: each of its sequences is told like a call, from its trigger to its end.
Result<Done> Board::watch_converters() {
  for (std::size_t i = 0; i < setup_.description.watch.size(); ++i) {
    const std::string& name = setup_.description.watch[i];
    int number = 0;
    if (std::sscanf(name.c_str(), "adc%1d", &number) != 1 || name.size() != 4) continue;
    stm32::Adc* converter = chip_->converter(number);
    if (converter == nullptr) {
      return Error{ErrorKind::bad_input, setup_.description.name + ": watch",
                   "the part has no '" + name + "'", ""};
    }
    const auto place = static_cast<std::uint16_t>(i);
    converter->on_sequence([this, place](Nanoseconds began, Nanoseconds ended) {
      happened_.add(io::Kind::function_call, place, ended, io::FunctionCall{began, ended - began});
    });
  }
  return Done{};
}

stm32::Region Board::unanswered_region() {
  return {kPeripherals, kPeripherals_size, &unanswered_};
}

std::vector<stm32::Region> Board::core_regions() {
  return {{0xE0000000, kPage, &itm_},         {0xE0001000, kPage, &cycle_counter_},
          {0xE0002000, kPage, &flash_patch_}, {0xE0040000, kPage, &tpiu_},
          {0xE0041000, kPage, &etm_},         {0xE0042000, kPage, &debug_mcu_}};
}

std::vector<std::uint8_t> Board::system_rom() const {
  const Part& part = *setup_.part;
  std::vector<std::uint8_t> rom(part.system_rom.size, 0xFF);  // erased: no boot loader in it
  const auto put = [&](std::uint32_t address, std::uint64_t value, unsigned size) {
    std::memcpy(&rom[address - part.system_rom.base], &value, size);
  };
  put(part.uid_base, 0x0032003151470D31u ^ setup_.run.seed, 8);  // one chip per seed
  put(part.uid_base + 8, 0x30363938, 4);
  put(part.flash_size_base, part.flash.size / 1024, 2);
  return rom;
}

void Board::power_on(const std::string& versions) {
  chip_->reset(stm32::ResetCause::power_on);
  retime();
  systick_.reset();
  cycle_counter_.reset();
  channel_.set_hello(versions);
  for (const std::string& oddity : setup_.image.oddities()) report({0, "image", oddity});
  report_unknown_watches();
  boundary_.at(0);
  channel_.set_state(io::BoardState::running);
  std::ignore = channel_.post(0, happened_.bytes());
  happened_.clear();
  reported_ = true;
}

// A board file serves many images, so a function that this one lacks is no error, but it is said.
void Board::report_unknown_watches() {
  for (const std::string& name : setup_.description.watch) {
    const bool converter = name.size() == 4 && name.compare(0, 3, "adc") == 0;
    if (converter || !setup_.image.functions_named(name).empty()) continue;
    report({0, "watch", "the image has no function '" + name + "'"});
  }
}

void Board::on_timer() {
  events_.run_until(emulator_.now());
  emulator_.arm(events_.next_deadline());
}

void Board::synchronise() {
  const Nanoseconds now = events_.now();
  // What else happens at this very instant belongs to the step that ends here.
  if (events_.next_deadline() <= now) return boundary_.at(now);
  report_clocks();
  report_busy();
  if (!reported_) {
    wires_.at_boundary(now);
    devices_.report(now);
    const auto posted = channel_.post(now, happened_.bytes());
    if (!posted) refuse(posted.error());
    happened_.clear();
  }
  reported_ = false;
  await_orders();
}

void Board::await_orders() {
  // For ever: the harness takes this process with it when it dies.
  WHIRL_CHECK(channel_.wait(-1));
  const io::Delivery orders = channel_.received();
  io::Reader reader(orders.bytes);
  while (reader.next()) on_message(reader);
  WHIRL_CHECK(reader.complete());
  WHIRL_CHECK(orders.t_ns > events_.now(), orders.t_ns, events_.now());
  boundary_.at(orders.t_ns);
  wires_.after_boundary(events_.now(), orders.t_ns);
}

void Board::on_message(const io::Reader& message) {
  if (message.header().kind == io::Kind::fault) {
    if (core_faults_.on_fault(message.as<io::FaultCommand>())) return;
  }
  if (devices_.on_message(message)) return;
  if (message.header().kind == io::Kind::end_of_run) {
    watch_.run_ends(events_.now());
    wires_.run_ends(events_.now());
    devices_.run_ends(events_.now());
    add_statistics();
    finish(io::BoardState::ended);
  }
}

void Board::retime() {
  const stm32::Clocks& clocks = chip_->clocks();
  if (clocks.hclk_Hz() <= 0.0) return;  // not out of reset
  emulator_.retime({clocks.hclk_Hz(), clocks.pclk1_Hz(), clocks.pclk2_Hz(), chip_->flash_timing()});
}

// The firmware may set up its clocks at any time; the harness learns at the next boundary.
void Board::report_clocks() {
  const stm32::Clocks& clocks = chip_->clocks();
  const io::ClockSetup now{chip_->sysclk_Hz(), clocks.hclk_Hz(), clocks.pclk1_Hz(),
                           clocks.pclk2_Hz()};
  const auto all = [](const io::ClockSetup& c) {
    return std::array{c.sysclk_Hz, c.hclk_Hz, c.pclk1_Hz, c.pclk2_Hz};
  };
  if (all(now) == all(clocks_told_)) return;
  clocks_told_ = now;
  happened_.add(io::Kind::clock_setup, 0, events_.now(), now);
  profile_.in(kSettled_ns);
}

void Board::report_busy() {
  const Nanoseconds now = events_.now(), slept_ns = emulator_.slept_ns();
  if (now == busy_told_ns_) return;
  const io::BusyTime busy{busy_told_ns_, now - busy_told_ns_ - (slept_ns - slept_told_ns_)};
  happened_.add(io::Kind::busy_time, 0, now, busy);
  busy_told_ns_ = now;
  slept_told_ns_ = slept_ns;
}

void Board::refuse(const Error& error) {
  channel_.fail(error);
  emulator_.end();
  std::abort();  // as in finish()
}

// Instructions take the same time whatever SYSCLK is: a profile for 168 MHz does not fit 16 MHz.
void Board::check_profile() {
  if (setup_.description.ns_per_instruction == 0) return;  // it takes cycles
  if (profile_told_Hz_ == clocks_told_.sysclk_Hz) return;
  const double cycles =
      clocks_told_.sysclk_Hz * 1e-9 * static_cast<double>(setup_.description.ns_per_instruction);
  if (cycles >= kLeastCycles && cycles <= kMostCycles) return;
  profile_told_Hz_ = clocks_told_.sysclk_Hz;
  char text[160];
  std::snprintf(text, sizeof text,
                "SYSCLK of %.6g MHz does not fit the timing profile: %lld ns per instruction are "
                "%.3g cycles",
                clocks_told_.sysclk_Hz * 1e-6,
                static_cast<long long>(setup_.description.ns_per_instruction), cycles);
  report({events_.now(), "board", text});
}

void Board::finish(io::BoardState state) {
  channel_.set_state(state);
  std::ignore = channel_.post(events_.now(), happened_.bytes());
  emulator_.end();
  std::abort();  // never reached; GCC forgets [[noreturn]] on virtual calls
}

static_assert(static_cast<std::uint16_t>(stm32::ResetCause::independent_watchdog) ==
              io::kResetByIndependentWatchdog);
static_assert(static_cast<std::uint16_t>(stm32::ResetCause::window_watchdog) ==
              io::kResetByWindowWatchdog);

void Board::core_was_reset(stm32::ResetCause cause) {
  happened_.add(io::Kind::board_reset, static_cast<std::uint16_t>(cause), events_.now(), nullptr,
                0);
  watch_.core_was_reset();
  chip_->reset(cause);
  systick_.reset();
  cycle_counter_.reset();
}

io::CpuFault Board::fault_registers(const Registers& registers) {
  io::CpuFault fault;
  for (int i = 0; i < 13; ++i) fault.r[i] = registers(i);
  const auto word = [this](std::uint32_t offset) { return emulator_.system_control_word(offset); };
  fault.cfsr = word(kCfsr);
  fault.hfsr = word(kHfsr);
  fault.mmfar = word(kMmfar);
  fault.bfar = word(kBfar);
  return fault;
}

void Board::exception(const CoreState& before, const CoreState& after, const Registers& registers) {
  if (!watch_.exception(before, after)) return;
  if (after.exception() < kHardFault || after.exception() > kUsageFault) return;
  io::CpuFault fault = fault_registers(registers);
  fault.exception = after.exception();
  fault.pc = before.pc;
  fault.lr = before.lr;
  fault.sp = before.sp;
  fault.xpsr = before.xpsr;
  const std::string text = backtrace(setup_.image, peek(), before.pc, before.lr, before.sp);
  happened_.add(io::Kind::cpu_fault, 0, after.now, fault, text.data(),
                static_cast<std::uint32_t>(text.size()));
}

void Board::core_stopped(StoppedCore why, Nanoseconds now, const Registers& registers) {
  io::CpuFault fault = fault_registers(registers);
  fault.exception = static_cast<std::uint32_t>(why);
  fault.sp = registers(13);
  fault.lr = registers(14);
  fault.pc = registers(15);
  fault.xpsr = registers(25);
  const std::string text = setup_.image.describe(fault.pc);
  happened_.add(io::Kind::cpu_fault, 0, now, fault, text.data(),
                static_cast<std::uint32_t>(text.size()));
  channel_.set_state(io::BoardState::cpu_locked);
  std::ignore = channel_.post(now, happened_.bytes());
  emulator_.end();
  std::abort();  // as in finish()
}

void Board::report(const io::Finding& finding) {
  rack::tell_finding(finding, happened_);
}

void Board::set(int irq, bool level) {
  watch_.line_changed(kFirstInterrupt + static_cast<std::uint32_t>(irq), level, events_.now());
  emulator_.set_interrupt(irq, level);
}

bool Board::read(std::uint32_t address, unsigned size, std::uint32_t& value) {
  value = 0;
  return emulator_.read_bus(address, &value, size);
}

bool Board::write(std::uint32_t address, unsigned size, std::uint32_t value) {
  return emulator_.write_bus(address, &value, size);
}

std::uint64_t Board::read(std::uint32_t address, unsigned size) {
  std::uint64_t value = 0;
  emulator_.peek(address, &value, size);
  return value;
}

void Board::program(std::uint32_t address, std::uint64_t value, unsigned size) {
  const std::uint64_t cells = read(address, size) & value;  // programming clears bits only
  emulator_.write_cells(address, &cells, size);
}

void Board::erase(std::uint32_t address, std::uint32_t bytes) {
  const std::vector<std::uint8_t> blank(bytes, 0xFF);
  emulator_.write_cells(address, blank.data(), blank.size());
}

}  // namespace whirl::board
