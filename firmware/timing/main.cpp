// A timing image: what the core and its flash need for each kind of instruction, as cycles of DWT_CYCCNT,
// sent as text (report.hpp). The same ELF runs on the part and on the virtual board: whirl validate --timing.
//
//   Kernels  each is run twice; the second run counts, less the run of the empty one
//   Blocks   code in flash at every number of wait states, warm and with empty caches; calls and loop of the
//            measurement are taken off by calling nothing at all
#include "firmware/timing/code_blocks.hpp"
#include "firmware/timing/compiled.hpp"
#include "firmware/timing/cycle_counter.hpp"
#include "firmware/timing/exceptions.hpp"
#include "firmware/timing/kernel.hpp"
#include "firmware/timing/part.hpp"
#include "firmware/timing/report.hpp"

namespace fw::timing {
namespace {

alignas(16) constinit std::uint32_t ram[256]{};
alignas(16) constinit std::uint16_t code_ram[520]{};

constexpr std::uint32_t kShort_bytes = 512, kTick_bytes = 16 * 1024;

std::uint32_t less(std::uint32_t cycles, std::uint32_t empty) {
  return cycles > empty ? cycles - empty : 0;
}

std::uint32_t empty_cycles() {
  const Code empty = loop_kernels()[0].code;
  empty(ram);
  return empty(ram);
}

void run_kernels(std::span<const Kernel> kernels, std::string_view after = "") {
  const std::uint32_t empty = empty_cycles();
  for (const Kernel& kernel : kernels) {
    kernel.code(ram);
    report({kernel.name, after}, kernel.iterations, less(kernel.code(ram), empty));
  }
}

std::uint32_t cost_of(std::string_view kernel) {
  for (const Kernel& it : integer_kernels()) {
    if (kernel != it.name) continue;
    it.code(ram);
    return it.code(ram);
  }
  return 0;
}

// What operands make of an instruction that ends early where it can.
void run_operands(std::string_view name, std::string_view large, std::string_view small) {
  constexpr std::uint32_t kIterations = 64;  // of either kernel
  report({name}, kIterations, less(cost_of(large), cost_of(small)));
}

// The serial line may be on this bus: its rate is right again when a row is sent.
void run_on_slow_bus(std::span<const Kernel> kernels) {
  const std::uint32_t empty = empty_cycles();
  for (const Kernel& kernel : kernels) {
    divide_apb1_by_4(true);
    kernel.code(ram);
    const std::uint32_t taken = kernel.code(ram);
    divide_apb1_by_4(false);
    report({kernel.name, "_apb1_by_4"}, kernel.iterations, less(taken, empty));
  }
}

void run_exceptions(std::span<const ExceptionKernel> kernels, std::string_view after = "") {
  const std::uint32_t empty = empty_cycles();
  for (const ExceptionKernel& it : kernels) {
    run(it, ram);
    report({it.kernel.name, after}, it.kernel.iterations, less(run(it, ram), empty));
  }
}

void run_systick() {
  const Block background = straight_16(kTick_bytes);
  const std::uint32_t from = cycles();
  background(0);
  const std::uint32_t alone = cycles() - from;
  std::uint32_t interrupts = 0;
  const std::uint32_t with = cycles_with_systick(background, interrupts);
  report({"systick_in_straight_code"}, interrupts, less(with, alone));
}

// Calls as a loop that is the same for every block.
__attribute__((noinline)) std::uint32_t calls(Block block, std::uint32_t argument,
                                              std::uint32_t passes) {
  const std::uint32_t from = cycles();
  for (std::uint32_t i = 0; i < passes; ++i) block(argument);
  return cycles() - from;
}

struct Fetch {
  const char* name;
  Block (*block)(std::uint32_t bytes);
};
constexpr Fetch kFetches[] = {{"straight_16", straight_16}, {"straight_32", straight_32}};

std::uint32_t warm(Block block, std::uint32_t passes) {
  calls(block, 0, 1);
  return calls(block, 0, passes);
}

// Per 16 bytes of straight code, passed four times.
void run_warm(const Fetch& fetch, std::uint32_t bytes,
              std::initializer_list<std::string_view> name) {
  constexpr std::uint32_t kPasses = 4;
  const std::uint32_t nothing = warm(fetch.block(0), kPasses);
  report(name, kPasses * bytes / kLine_bytes, less(warm(fetch.block(bytes), kPasses), nothing));
}

void run_cold(const Fetch& fetch, std::uint32_t bytes, std::uint32_t wait_states, FlashAid aid,
              std::initializer_list<std::string_view> name) {
  const std::uint32_t nothing = warm(fetch.block(0), 1);
  set_flash(wait_states, aid);
  report(name, bytes / kLine_bytes, less(calls(fetch.block(bytes), 0, 1), nothing));
}

struct Aid {
  const char* name;
  FlashAid aid;
};
constexpr Aid kAids[] = {{"none", FlashAid::none},
                         {"prefetch", FlashAid::prefetch},
                         {"cache", FlashAid::cache},
                         {"all", FlashAid::all}};

void run_wait_states(const Aid& aid) {
  for (std::uint32_t ws = 0; ws <= kMost_wait_states; ++ws) {
    set_flash(ws, aid.aid);
    const Digits digits(ws);
    for (const Fetch& fetch : kFetches) {
      run_warm(fetch, kShort_bytes, {fetch.name, "_ws", digits, "_", aid.name});
    }
    constexpr std::uint32_t kPasses = 4, kFew = 8;
    const std::uint32_t nothing = warm(jumps(0), kPasses);
    report({"jumps_ws", digits, "_", aid.name}, kPasses * kFew,
           less(warm(jumps(kFew), kPasses), nothing));
  }
}

// Loops through ever more code than the cache holds.
void run_working_sets() {
  set_flash(kMost_wait_states, FlashAid::all);
  for (std::uint32_t bytes = 256; bytes <= kStraight_bytes; bytes *= 2) {
    for (const Fetch& fetch : kFetches) {
      run_warm(fetch, bytes, {fetch.name, "_loop_", Digits(bytes)});
    }
  }
  set_flash(kMost_wait_states, FlashAid::cache);
  for (const std::uint32_t bytes : {512u, 4096u}) {
    for (const Fetch& fetch : kFetches) {
      run_warm(fetch, bytes, {fetch.name, "_loop_", Digits(bytes), "_cache_only"});
    }
  }
  for (std::uint32_t bytes = 256; bytes <= kStraight_bytes; bytes *= 4) {
    for (const Fetch& fetch : kFetches) {
      run_cold(fetch, bytes, kMost_wait_states, FlashAid::all,
               {fetch.name, "_cold_", Digits(bytes)});
    }
  }
  set_flash(kMost_wait_states, FlashAid::cache);
  const std::uint32_t nothing = warm(jumps(0), 1);
  set_flash(kMost_wait_states, FlashAid::cache);
  report({"jumps_cold_cache_only"}, kJumps, less(calls(jumps(kJumps), 0, 1), nothing));
}

void run_from_ram() {
  set_flash(0, FlashAid::none);
  for (const Fetch& fetch : kFetches) {
    const Block block = copied(fetch.block(kShort_bytes), kShort_bytes, code_ram);
    const std::uint32_t taken = warm(block, 1);
    const std::uint32_t nothing = warm(copied(fetch.block(0), 0, code_ram), 1);
    report({fetch.name, "_in_ram"}, kShort_bytes / kLine_bytes, less(taken, nothing));
  }
  constexpr std::uint32_t kTurns = 200;
  const Block copy = copied(delay(), kDelay_bytes, code_ram);
  calls(copy, kTurns, 1);
  const std::uint32_t taken = calls(copy, kTurns, 1);
  report({"delay_loop_in_ram"}, kTurns - 1, less(taken, calls(copy, 1, 1)));
}

__attribute__((noinline)) std::uint32_t compiled(void (*code)(std::uint32_t*)) {
  code(ram);
  const std::uint32_t from = cycles();
  code(ram);
  return cycles() - from;
}

void run_compiled(std::string_view after = "") {
#ifdef __ARM_FP
  report({"biquad_float", after}, kSamples, compiled(biquad_float));
#endif
  report({"biquad_fixed", after}, kSamples, compiled(biquad_fixed));
}

// As products run: all wait states of the full clock, and all that helps against them.
void run_as_products_do() {
  constexpr std::string_view kAfter = "_as_product";
  set_flash(kMost_wait_states, FlashAid::all);
  run_exceptions(exception_kernels(), kAfter);
  run_kernels(literal_kernels(), kAfter);
  run_kernels(loop_kernels().subspan(1), kAfter);
  run_compiled(kAfter);
}

}  // namespace
}  // namespace fw::timing

extern "C" void fw_main() {
  using namespace fw::timing;
  start_part();
  start_cycle_counter();
  set_flash(0, FlashAid::none);
  begin_report();
  run_exceptions(exception_kernels());  // before any float: frames are short then
  run_systick();
  for (const auto kernels : {integer_kernels(), memory_kernels(), literal_kernels(),
                             branch_kernels(), loop_kernels(), bus_kernels()}) {
    run_kernels(kernels);
  }
  run_operands("udiv_large_over_small", "udiv_large", "udiv_small");
  run_operands("umull_large_over_small", "umull_large", "umull_small");
  run_on_slow_bus(bus_kernels().first(2));
  if (!float_kernels().empty()) {
    run_kernels(float_kernels());
    run_exceptions(exception_kernels().first(1), "_float_active");
  }
  run_compiled();
  for (const Aid& aid : kAids) {
    if (kHas_flash_cache || aid.aid == FlashAid::none || aid.aid == FlashAid::prefetch) {
      run_wait_states(aid);
    }
  }
  if (kHas_flash_cache) run_working_sets();
  run_as_products_do();
  run_from_ram();
  if (std::uint16_t* ccm = not_executable(); ccm != nullptr) {
    report({"fetch_from_ccm_faults"}, 1, faults(copied(straight_16(16), 16, ccm)) ? 1 : 0);
  }
  end_report();
}
