#include "harness/cli/probe_command.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

#include "base/interruption.hpp"
#include "base/places.hpp"
#include "base/random.hpp"
#include "harness/cli/bench_choice.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_board.hpp"
#include "harness/cli/find_file.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/executive/cpu_fault.hpp"
#include "harness/pacing/host_clock.hpp"
#include "io_bridges/openocd/core_probe.hpp"
#include "io_bridges/openocd/pc_samples.hpp"
#include "io_bridges/openocd/server.hpp"
#include "io_bridges/qemu/board/image.hpp"

namespace whirl::cli {
namespace {

using openocd::CoreProbe;

constexpr const char* kRecord = "fw_fault_record";  // of our images: firmware/hal/fault_record.hpp
constexpr std::uint32_t kRecord_magic = 0xFA01'7EC0;
constexpr int kRecord_words =
    23;  // magic, exception, r0..r12, sp, lr, pc, xpsr, cfsr, hfsr, mmfar, bfar

// The bench, its probe and the image, as the files say.
struct Wanted {
  bench::BenchDescription bench;
  std::string image_path;
  board::Image image;
  const board::Part* part = nullptr;
};

Result<Wanted> wanted(const ProbeOptions& options, const Composition& composition,
                      const char* command) {
  const std::string& root = composition.root;
  const Asker who{".", command};
  auto bench = bench_named(options.name, command, root);
  if (!bench) return bench.error();
  if (!bench.value().probe) {
    return Error{
        ErrorKind::bad_input, bench.value().file, "names no debug probe",
        "probe = { interface = \"interface/stlink.cfg\", target = \"target/stm32f1x.cfg\" }"};
  }
  const auto board = find_board(bench.value().board, who, root);
  if (!board) return board.error();
  const auto path = find_file(options.image, who, {root + "/build/firmware"}, ".elf");
  if (!path) return path.error();
  const board::Part* part = board::find_part(board.value().mcu);
  if (part == nullptr) {
    return Error{ErrorKind::bad_input, board.value().file,
                 "no part '" + board.value().mcu + "' is known", ""};
  }
  auto image = board::load_image(path.value(), *part);
  if (!image) return image.error();
  return Wanted{std::move(bench.value()), path.value(), std::move(image.value()), part};
}

std::vector<openocd::IdleSpan> idle_spans(const Wanted& all) {
  std::vector<openocd::IdleSpan> spans;
  if (!all.bench.probe->idle.empty()) {
    for (const board::Symbol* function : all.image.functions_named(all.bench.probe->idle)) {
      spans.push_back({function->address, function->address + function->size});
    }
    return spans;
  }
  for (const board::Segment& segment : all.image.segments()) {
    for (const openocd::IdleSpan& span : openocd::waits_in(segment.bytes, segment.address)) {
      if (all.image.function_at(span.from) != nullptr) spans.push_back(span);
    }
  }
  return spans;
}

// Random pauses of 0 to 2 ms: the tasks are periodic, and so would the samples be.
Result<std::vector<std::uint32_t>> sample(CoreProbe& probe, int count) {
  if (const auto started = probe.start_sampling(); !started) return started.error();
  pacing::MonotonicClock clock;
  RandomStream chance(static_cast<std::uint64_t>(clock.now_ns()), "pauses between samples");
  std::vector<std::uint32_t> pcs;
  for (int i = 0; i < count && interrupted_by() == 0; ++i) {
    clock.sleep_until(clock.now_ns() + static_cast<std::int64_t>(chance.uniform() * 2e6));
    const auto pc = probe.sample_pc();
    if (!pc) return pc.error();
    pcs.push_back(pc.value());
  }
  return pcs;
}

void show_functions(const Wanted& all, const std::vector<std::uint32_t>& pcs) {
  std::map<std::string, int> counts;
  for (const std::uint32_t pc : pcs) {
    const board::Symbol* function = all.image.function_at(pc);
    ++counts[function == nullptr ? "(no function of the image)" : function->name];
  }
  std::vector<std::pair<int, std::string>> order;
  order.reserve(counts.size());
  for (const auto& [name, count] : counts) order.emplace_back(count, name);
  std::sort(order.rbegin(), order.rend());
  constexpr std::size_t kShown = 12;
  for (std::size_t i = 0; i < order.size() && i < kShown; ++i) {
    std::printf("  %5.1f %%  %s\n", 100.0 * order[i].first / static_cast<double>(pcs.size()),
                order[i].second.c_str());
  }
}

int show_load(const Wanted& all, CoreProbe& probe, int count) {
  const auto spans = idle_spans(all);
  if (spans.empty()) {
    const std::string& idle = all.bench.probe->idle;
    return complain({ErrorKind::bad_input, all.bench.file,
                     idle.empty() ? "the image never waits for an interrupt"
                                  : "the image has no function '" + idle + "'",
                     "probe = { idle = ... } names the function in which it idles"});
  }
  const auto pcs = sample(probe, count);
  if (!pcs) return complain(pcs.error());
  const auto share = openocd::busy_share(pcs.value(), spans, all.part->flash.base,
                                         all.part->flash.base + all.part->flash.size);
  std::printf("  busy %.1f %% (95 %%: %.1f to %.1f %%) of %zu samples of the program counter\n",
              100.0 * share.share, 100.0 * share.low, 100.0 * share.high, share.samples);
  if (share.unknown > 0) {
    std::printf(
        "  %zu samples were outside of the image's code: halted, asleep without a clock, or "
        "another image\n",
        share.unknown);
  }
  show_functions(all, pcs.value());
  return share.samples == 0 ? 2 : 0;
}

void show_fault(const board::Image& image, const char* whence, const io::CpuFault& registers) {
  results::CpuFaultRecord record;
  record.registers = registers;
  record.backtrace = image.describe(registers.pc) + "\n" + image.describe(registers.lr & ~1u);
  const results::CpuFaultRow row = describe(record);
  std::printf("  %s: %s in %s, called from %s\n%s", whence, row.name.c_str(), row.where.c_str(),
              image.describe(registers.lr & ~1u).c_str(), row.registers.c_str());
}

int show_core(const Wanted& all, CoreProbe& probe) {
  const auto state = probe.look();
  if (!state) return complain(state.error());
  const openocd::CoreState& s = state.value();
  const bool faulted = s.exception >= 2 && s.exception <= 6;
  if (faulted) {
    io::CpuFault f;
    f.exception = s.exception;
    std::copy_n(s.stacked.begin(), 4, f.r);
    f.r[12] = s.stacked[4];
    f.lr = s.stacked[5];
    f.pc = s.stacked[6];
    f.xpsr = s.stacked[7];
    f.sp = s.sp;
    f.cfsr = s.cfsr;
    f.hfsr = s.hfsr;
    f.mmfar = s.mmfar;
    f.bfar = s.bfar;
    show_fault(all.image, "the core is in a fault", f);
  } else {
    std::printf(
        "  the core was at %s, in %s; cfsr 0x%08X hfsr 0x%08X\n", all.image.describe(s.pc).c_str(),
        s.exception == 0 ? "no exception" : ("exception " + std::to_string(s.exception)).c_str(),
        s.cfsr, s.hfsr);
  }
  const board::Symbol* kept = all.image.object_named(kRecord);
  if (kept == nullptr) return 0;
  const auto words = probe.read_words(kept->address, kRecord_words);
  if (!words) return complain(words.error());
  const auto& w = words.value();
  if (w[0] != kRecord_magic) {
    std::printf("  the image has kept no fault\n");
    return 0;
  }
  io::CpuFault f;
  f.exception = w[1];
  std::copy_n(w.begin() + 2, 13, f.r);
  f.sp = w[15];
  f.lr = w[16];
  f.pc = w[17];
  f.xpsr = w[18];
  f.cfsr = w[19];
  f.hfsr = w[20];
  f.mmfar = w[21];
  f.bfar = w[22];
  show_fault(all.image, "the image has kept a fault", f);
  return 0;
}

}  // namespace

Result<std::unique_ptr<openocd::Server>> connect_probe(const bench::DebugProbe& probe) {
  openocd::ServerOptions options;
  options.files = {probe.interface};
  if (!probe.serial.empty()) options.commands.push_back("adapter serial " + probe.serial);
  // The interface's file comes first, the target's after what is said of the adapter.
  options.commands.push_back("source [find " + probe.target + "]");
  options.commands.push_back("adapter speed " +
                             std::to_string(static_cast<int>(probe.speed_Hz / 1e3)));
  return openocd::Server::start(options);
}

int bench_flash_command(const ProbeOptions& options, const Composition& composition) {
  const auto all = wanted(options, composition, "whirl bench flash");
  if (!all) return complain(all.error());
  auto server = connect_probe(*all.value().bench.probe);
  if (!server) return complain(server.error());
  CoreProbe probe(server.value()->client());
  if (const auto done = probe.flash(all.value().image_path); !done) return complain(done.error());
  std::printf("%s: written, read back and started\n", shown_path(all.value().image_path).c_str());
  return 0;
}

int bench_probe_command(const ProbeOptions& options, const Composition& composition) {
  const auto all = wanted(options, composition, "whirl bench probe");
  if (!all) return complain(all.error());
  auto server = connect_probe(*all.value().bench.probe);
  if (!server) return complain(server.error());
  CoreProbe probe(server.value()->client());
  if (options.reset) {
    if (const auto done = probe.reset(); !done) return complain(done.error());
  }
  std::printf("%s on %s\n", shown_path(all.value().image_path).c_str(),
              all.value().bench.name.c_str());
  const int load = show_load(all.value(), probe, options.samples);
  return options.halt ? std::max(load, show_core(all.value(), probe)) : load;
}

}  // namespace whirl::cli
