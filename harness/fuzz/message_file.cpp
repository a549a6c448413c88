// Fuzzes the file of a run's messages through every sink: the bytes as the file itself, or, behind a 'Z',
// as the stream that its compression hides.
#include <fstream>

#include "base/scratch_folder.hpp"
#include "results/messages/message_file.hpp"
#include "results/sinks/replay.hpp"
#include "results/sinks/sink_types.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace whirl;
  static const ScratchFolder folder("/dev/shm");
  static const std::string file = folder.file("messages.whirl");
  static const auto all = results::sink_types();
  if (size > 0 && data[0] == 'Z') {
    results::MessageWriter out(
        file, {"p", 1, 1'000'000, {{"height", "m", "m"}}, {{"a", {}, {}, {}}, {"b", {}, {}, {}}}});
    io::Batch batch;
    batch.assign({data + 1, size - 1});
    out.add(batch);
    std::ignore = out.finish().ok();
  } else {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  std::ignore = results::replay(file, folder.path(), {all.begin(), all.end()}).ok();
  return 0;
}
