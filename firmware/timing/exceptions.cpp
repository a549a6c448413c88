#include "firmware/timing/exceptions.hpp"

#include <bit>

#include "firmware/hal/core_registers.hpp"
#include "firmware/hal/vectors.hpp"
#include "firmware/timing/cycle_counter.hpp"

extern "C" {
__attribute__((used)) std::uint32_t timing_ticks, timing_faults, timing_other_stack;
void timing_return();
void timing_pend();
void timing_tick();
void timing_fault();
void timing_switch();
}

// clang-format off
#define FW_HANDLER(name, code)                                                                     \
  __asm(".syntax unified\n.thumb\n.section .text." name ",\"ax\",%progbits\n.balign 16\n"          \
        ".global " name "\n.type " name ", %function\n" name ":\n" code "\n.section .text\n")
#define FW_ADDRESS(reg, symbol)                                                                    \
  "movw " reg ", #:lower16:" symbol "\n movt " reg ", #:upper16:" symbol "\n"

FW_HANDLER("timing_return", "bx lr");
FW_HANDLER("timing_pend", "str r1, [r2]\n bx lr");
FW_HANDLER("timing_tick", FW_ADDRESS("r0", "timing_ticks")
           "ldr r1, [r0]\n adds r1, r1, #1\n str r1, [r0]\n bx lr");
// Counts, clears the fault's cause and returns to where the faulting call was made.
FW_HANDLER("timing_fault", FW_ADDRESS("r0", "timing_faults")
           "ldr r1, [r0]\n adds r1, r1, #1\n str r1, [r0]\n"
           "ldr r1, [sp, #20]\n bic r1, r1, #1\n str r1, [sp, #24]\n"
           "mov.w r1, #0x1000000\n str r1, [sp, #28]\n"
           "movw r0, #0xED28\n movt r0, #0xE000\n mvn.w r1, #0\n str r1, [r0]\n str r1, [r0, #4]\n"
           "dsb\n bx lr");
FW_HANDLER("timing_switch",
           "mrs r0, psp\n stmdb r0!, {r4-r11}\n" FW_ADDRESS("r2", "timing_other_stack")
           "ldr r1, [r2]\n str r0, [r2]\n ldmia r1!, {r4-r11}\n msr psp, r1\n bx lr");
// The other thread: switches back for ever.
FW_HANDLER("timing_other_thread", "1: str.n r1, [r2]\n dsb\n isb\n b.n 1b");

// r1, r2: what sets PendSV pending, and where (SCB_ICSR).
#define FW_PENDING "mov.w r1, #0x10000000\n movw r2, #0xED04\n movt r2, #0xE000\n"
FW_KERNEL_CODE(svc_round_trip, 32, FW_PENDING, "svc #0")
FW_KERNEL_CODE(svc_then_pendsv, 32, FW_PENDING, "svc #0")
FW_KERNEL_CODE(pendsv_round_trip, 32, FW_PENDING, "str.n r1, [r2]\n dsb\n isb")
// The thread moves to a process stack at r5 + 128. The other one's frame is made at r5 + 192: registers r4
// to r11, then r0 - r3, r12, lr, pc, xPSR.
FW_KERNEL_CODE_ENDING(context_switches, 16,
  FW_PENDING
  "add.w r0, r5, #192\n" FW_ADDRESS("r3", "timing_other_stack") "str r0, [r3]\n"
  "str r1, [r0, #36]\n str r2, [r0, #40]\n"
  FW_ADDRESS("r3", "timing_other_thread") "bic r3, r3, #1\n str r3, [r0, #56]\n"
  "mov.w r3, #0x1000000\n str r3, [r0, #60]\n"
  "add.w r0, r5, #128\n msr psp, r0\n movs r3, #2\n msr control, r3\n isb\n",
  "str.n r1, [r2]\n dsb\n isb",
  "movs r3, #0\n msr control, r3\n isb")
// clang-format on

namespace fw::timing {
namespace {

constexpr unsigned kHardFault = 2, kSvc = 10, kPendSv = 13,
                   kSysTick = 14;  // of VectorTable::system
using Table = hal::VectorTable<0>;
using SystemControl = hw::SCB;
using TickControl = hw::Reg32<0xE000'E010>;
using TickReload = hw::Reg32<0xE000'E014>;
using TickValue = hw::Reg32<0xE000'E018>;
constexpr std::uint32_t kTick_cycles = 1000, kTick_on = 7;  // core clock, interrupt, enabled

constexpr Table make_table(hal::Handler svc, hal::Handler pendsv) {
  Table table;
  table.system[kHardFault] = timing_fault;
  table.system[kSvc] = svc;
  table.system[kPendSv] = pendsv;
  table.system[kSysTick] = timing_tick;
  return table;
}

// VTOR's lower seven bits are zero.
alignas(128) constinit const Table returning = make_table(timing_return, timing_return);
alignas(128) constinit const Table pending = make_table(timing_pend, timing_return);
alignas(128) constinit const Table switching = make_table(timing_return, timing_switch);

class Vectors {  // these, while it lives
 public:
  explicit Vectors(const Table& table) : before_(SystemControl::VTOR::read()) {
    use(std::bit_cast<std::uint32_t>(&table));
  }
  ~Vectors() { use(before_); }
  Vectors(const Vectors&) = delete;
  Vectors& operator=(const Vectors&) = delete;

 private:
  static void use(std::uint32_t table) {
    SystemControl::VTOR::write(table);
    __asm volatile("dsb\n isb" ::: "memory");
  }
  std::uint32_t before_;
};

std::uint32_t read(const std::uint32_t& counted) {
  return const_cast<const volatile std::uint32_t&>(counted);
}

}  // namespace

std::span<const ExceptionKernel> exception_kernels() {
  static constexpr ExceptionKernel kKernels[] = {
      {{"svc_round_trip", kernel_svc_round_trip, 32}, Handlers::returning},
      {{"svc_then_pendsv", kernel_svc_then_pendsv, 32}, Handlers::pending},
      {{"pendsv_round_trip", kernel_pendsv_round_trip, 32}, Handlers::returning},
      {{"context_switches", kernel_context_switches, 16}, Handlers::switching},
  };
  return kKernels;
}

std::uint32_t run(const ExceptionKernel& kernel, std::uint32_t* ram) {
  const Vectors vectors(kernel.handlers == Handlers::pending     ? pending
                        : kernel.handlers == Handlers::switching ? switching
                                                                 : returning);
  return kernel.kernel.code(ram);
}

std::uint32_t cycles_with_systick(Block block, std::uint32_t& interrupts) {
  const Vectors vectors(returning);
  const std::uint32_t before = read(timing_ticks);
  TickReload::write(kTick_cycles - 1);
  TickValue::write(0);
  TickControl::write(kTick_on);
  const std::uint32_t from = cycles();
  block(0);
  const std::uint32_t taken = cycles() - from;
  TickControl::write(0);
  interrupts = read(timing_ticks) - before;
  return taken;
}

bool faults(Block block) {
  const Vectors vectors(returning);
  const std::uint32_t before = read(timing_faults);
  block(0);
  return read(timing_faults) != before;
}

}  // namespace fw::timing
