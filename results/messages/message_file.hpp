// messages.whirl: every message of a run and every row of its signals, in the order in which they
// crossed. All other files of a run are made from it (results/sinks).
//
//   Written  as the run goes, in bounded memory: who is killed leaves all but the last instants
//   Format   "WHIRLMSG", version (u32), size of the head (u32), number of rows and of the file's bytes
//            (u64; all ones until the run is over), the head as JSON (run_head.hpp); then messages as
//            they crossed (io::Header and payload), in zstd frames of 1 MiB with checksums. A row is a message of the kind `signals`: one
//            64-bit number per column, XORed with the row before, most significant bytes of all
//            columns first, which halves what zstd leaves of it
//   Valid    on machines of this byte order, by a whirl of the same version of the messages
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/result.hpp"
#include "io_bridges/messages/messages.hpp"
#include "results/messages/run_head.hpp"

namespace whirl::results {

class MessageWriter {
 public:
  MessageWriter(const std::string& path, const RunHead& head);
  ~MessageWriter();
  MessageWriter(MessageWriter&&) noexcept;
  MessageWriter& operator=(MessageWriter&&) noexcept;

  void add(const io::Batch& batch);
  void add_row(std::int64_t t_ns, std::span<const double> values);  // one per column
  // Errors  host: what could not be written since it was opened. What could be is left, as of a run
  //         that was cut off; of a file that could not even begin nothing is.
  Result<Done> finish();

  const RunHead& head() const;
  std::uint64_t rows() const;  // so far

 private:
  struct Inner;
  std::unique_ptr<Inner> inner_;
};

class MessageReader {
 public:
  enum class Next { message, row, end };

  // Errors  bad_input: it cannot be opened, or is no file of messages
  static Result<MessageReader> open(const std::string& path);
  ~MessageReader();
  MessageReader(MessageReader&&) noexcept;
  MessageReader& operator=(MessageReader&&) noexcept;

  const RunHead& head() const;
  std::optional<std::uint64_t> rows() const;  // nothing: its run was cut off

  // Errors  bad_input: what follows is damaged, or missing. Where a run was cut off is an end.
  Result<Next> next();
  const io::Reader& message() const;  // until the following next(); of a row: its header
  std::span<const double> row() const;

 private:
  struct Inner;
  explicit MessageReader(std::unique_ptr<Inner> inner);
  std::unique_ptr<Inner> inner_;
};

}  // namespace whirl::results
