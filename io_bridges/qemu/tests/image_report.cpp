#include "io_bridges/qemu/tests/image_report.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "harness/target/virtual_board.hpp"
#include "io_bridges/board_description/board_text.hpp"

namespace whirl::board_test {
namespace {

std::string description(const ImageBoard& board) {
  return std::string(R"({"board":"driver images","mcu":")") + board.part.mcu + R"(","hse_Hz":)" +
         board.part.hse_Hz + R"(,"folder":")" + board.folder + R"(","image":")" + WHIRL_IMAGES +
         "/" + board.image + R"(.elf","devices":[{"name":"terminal","type":"serial","bus":")" +
         board.part.terminal + R"(","baud":115200})" + board.devices + "]}";
}

void hear(ImageRun& run, const io::Batch& happened) {
  for (io::Reader r(happened.bytes()); r.next();) {
    const std::string payload(r.payload().begin(), r.payload().end());
    if (r.header().kind == io::Kind::uart_received) run.text += payload;
    if (r.header().kind == io::Kind::finding) run.findings += payload + "\n";
    if (r.header().kind == io::Kind::cpu_fault) ++run.faults;
  }
}

void let_it_run(VirtualBoard& board, ImageRun& run, int milliseconds, const Sense& sense) {
  io::Batch happened, sensed;
  for (int k = 1; k <= milliseconds && run.text.find("\ndone 1\n") == std::string::npos; ++k) {
    sensed.clear();
    if (sense) sense(k - 1, sensed);
    board.run(k * 1'000'000LL, sensed);
    const auto state = board.arrive(happened);
    hear(run, happened);
    if (!state) run.error += state.error().message();
    if (!state || state.value() != TargetState::running) break;
  }
  board.stop(happened);
}

}  // namespace

ImageRun run_image(const ImageBoard& image_board, int milliseconds, const Sense& sense) {
  ImageRun run;
  VirtualBoardOptions options;
  const auto start = read_board_text(description(image_board));
  EXPECT_TRUE(start) << image_board.devices;
  if (start) options.board = start.value();
  VirtualBoard board(options);
  if (const auto started = board.start(); !started) {
    run.error = started.error().message();
    return run;
  }
  let_it_run(board, run, milliseconds, sense);
  std::istringstream lines(run.text);
  std::string name;
  std::uint32_t value = 0;
  while (lines >> name >> value) run.report[name].push_back(value);
  if (run.report.count("done") == 0)
    run.error += "never done; it said:\n" + run.text + run.findings;
  return run;
}

void expect_between(std::uint32_t low, const Values& got, std::uint32_t high) {
  ASSERT_EQ(got.size(), 1u);
  EXPECT_GE(got[0], low);
  EXPECT_LE(got[0], high);
}

}  // namespace whirl::board_test
