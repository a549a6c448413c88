#include "firmware/timing/report.hpp"

#include "firmware/timing/part.hpp"

namespace fw::timing {
namespace {

constinit std::uint32_t rows = 0;

}  // namespace

Digits::Digits(std::uint32_t value) {
  do {
    text_[--at_] = static_cast<char>('0' + value % 10);
    value /= 10;
  } while (value != 0);
}

void begin_report() {
  send("timing 1 ");
  send(kPartName);
  send("\n");
}

void report(std::initializer_list<std::string_view> parts, std::uint32_t iterations,
            std::uint32_t cycles) {
  send("row ");
  for (const std::string_view part : parts) send(part);
  send(" ");
  send(Digits(iterations));
  send(" ");
  send(Digits(cycles));
  send("\n");
  ++rows;
}

void end_report() {
  send("end ");
  send(Digits(rows));
  send("\n");
}

}  // namespace fw::timing
