// Fuzzes firmware images: segments, symbols, and what is asked of them.
#include "io_bridges/qemu/board/image.hpp"

#include "harness/fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace whirl;
  const auto image = board::load_image(fuzz::path_of(data, size), *board::find_part("stm32f405rg"));
  if (!image) return 0;
  for (const board::Symbol& symbol : image.value().symbols()) {
    std::ignore = image.value().describe(symbol.address);
    std::ignore = image.value().functions_named(symbol.name);
  }
  std::ignore = image.value().object_named("x");
  return 0;
}
