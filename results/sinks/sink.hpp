// What a run's messages become: each sink makes one file, or one per board, of one format. A new one is
// a file of its own and a line in sink_types.cpp.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/output_file.hpp"
#include "base/result.hpp"
#include "io_bridges/messages/messages.hpp"
#include "results/messages/run_head.hpp"

namespace whirl::results {

class Sink {
 public:
  virtual ~Sink() = default;

  // In the order in which they crossed; header().board is below the number of nodes.
  virtual void on_message(const io::Reader& /*message*/) {}
  virtual void on_row(std::int64_t /*t_ns*/, std::span<const double> /*values*/) {}
  // Closes its files. Errors  host: of each that is lost; nothing of it remains
  virtual std::vector<Error> finish() = 0;

 protected:
  Sink() = default;
  Sink(Sink&&) = default;
  Sink& operator=(Sink&&) = default;
};

struct SinkSetup {
  const RunHead& head;
  std::string folder;      // where its files go
  std::uint64_t rows = 0;  // of signals that will come
};

struct SinkType {
  std::string_view format;  // "csv": what `whirl export` calls it
  std::string_view makes;   // its files, for people
  bool in_each_run = false;
  std::unique_ptr<Sink> (*make)(const SinkSetup& setup) = nullptr;
};

template <typename T>
std::unique_ptr<Sink> make_sink(const SinkSetup& setup) {
  return std::make_unique<T>(setup);
}

inline void close(OutputFile& file, std::vector<Error>& lost) {
  if (const auto closed = file.close(); !closed) lost.push_back(closed.error());
}

// "FOLDER/bus.csv"; of a board with a name FOLDER/bus_NAME.csv.
inline std::string file_of_node(const SinkSetup& setup, std::size_t node, const std::string& stem,
                                const std::string& extension) {
  const std::string& name = setup.head.nodes[node].name;
  return setup.folder + "/" + stem + (name.empty() ? "" : "_" + name) + extension;
}

}  // namespace whirl::results
