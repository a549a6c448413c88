// Runs an image in the manner of other people's drivers on a whole part: it reports what it measured as "name value"
// lines on its terminal, the last one "done 1".
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "io_bridges/messages/messages.hpp"

namespace whirl::board_test {

using Values = std::vector<std::uint32_t>;
using Report = std::map<std::string, Values>;

struct ImageRun {
  Report report;
  std::string text, findings, error;
  int faults = 0;
};

struct PartUnderTest {
  const char *mcu, *hse_Hz, *terminal;
};
inline constexpr PartUnderTest kF405 = {"stm32f405rg", "8000000", "usart2"};
inline constexpr PartUnderTest kF103 = {"stm32f103cb", "12000000", "usart1"};

struct ImageBoard {
  std::string image, devices;  // devices: JSON, each with a comma before it
  PartUnderTest part = kF405;
  std::string folder = {};  // where its parts leave their files
};

// What is sensed from each millisecond on, if anything.
using Sense = std::function<void(int millisecond, io::Batch& sensed)>;

// Until the image says that it is done, at most so many virtual milliseconds.
ImageRun run_image(const ImageBoard& board, int milliseconds, const Sense& sense = {});

void expect_between(std::uint32_t low, const Values& got, std::uint32_t high);

}  // namespace whirl::board_test
