// Fuzzes the ESC's serial line: frames and text, in pieces of any size.
#include "io_bridges/protocols/esc_stream.hpp"

#include <algorithm>

#include "base/check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace whirl::io;
  if (size == 0) return 0;
  const std::size_t piece = 1 + data[0];
  EscStreamDecoder decoder;
  decoder.on_sample([](const EscSample&) {});
  decoder.on_line([](const std::string& line) {
    WHIRL_CHECK(!line.empty() && line.size() <= 512, line.size());
  });
  for (std::size_t at = 1; at < size; at += piece) {
    decoder.decode({data + at, std::min(piece, size - at)});
  }
  return 0;
}
