#include <zstd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "results/messages/file_format.hpp"
#include "results/messages/message_file.hpp"
#include "results/messages/row_code.hpp"

namespace whirl::results {
namespace {

// A flight shrinks to 56 %; level 1 makes it 49 % in three times the time, level 6 no less.
constexpr int kLevel = -3;
// A frame's end carries its checksum, and a reader trusts what is before it.
constexpr std::size_t kFrame_B = 1u << 20;

}  // namespace

struct MessageWriter::Inner {
  Inner(const std::string& file_path, const RunHead& run)
      : path(file_path),
        head(run),
        out(file_path, std::ios::binary),
        row_code(head.columns.size()),
        context(ZSTD_createCCtx(), ZSTD_freeCCtx),
        packed(ZSTD_CStreamOutSize()) {
    const std::string text = head_text(head);
    const FileStart start{.head_size = static_cast<std::uint32_t>(text.size())};
    out.write(reinterpret_cast<const char*>(&start), sizeof start);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    check_state();
    if (context == nullptr || !set(ZSTD_c_compressionLevel, kLevel) ||
        !set(ZSTD_c_checksumFlag, 1)) {
      lose("zstd gives no stream");
    }
  }

  bool set(ZSTD_cParameter parameter, int value) const {
    return ZSTD_isError(ZSTD_CCtx_setParameter(context.get(), parameter, value)) == 0;
  }
  void lose(const std::string& why) {
    if (lost.empty()) lost = why;
  }
  void check_state() {
    if (!out) lose(errno != 0 ? std::strerror(errno) : "it cannot be opened");
  }

  void put(const void* data, std::size_t size, ZSTD_EndDirective how = ZSTD_e_continue) {
    ZSTD_inBuffer in{data, size, 0};
    std::size_t left = 1;
    while (lost.empty() && (in.pos < in.size || (how == ZSTD_e_end && left != 0))) {
      ZSTD_outBuffer to{packed.data(), packed.size(), 0};
      left = ZSTD_compressStream2(context.get(), &to, &in, how);
      if (ZSTD_isError(left) != 0) return lose(ZSTD_getErrorName(left));
      errno = 0;
      out.write(packed.data(), static_cast<std::streamsize>(to.pos));
      check_state();
    }
  }

  void add(const void* data, std::size_t size) {
    put(data, size);
    in_frame += size;
    if (in_frame < kFrame_B) return;
    put(nullptr, 0, ZSTD_e_end);
    in_frame = 0;
  }

  void close() {
    put(nullptr, 0, ZSTD_e_end);
    if (!lost.empty()) return out.close();
    errno = 0;
    const std::uint64_t figures[] = {rows, static_cast<std::uint64_t>(out.tellp())};
    out.seekp(offsetof(FileStart, rows));
    out.write(reinterpret_cast<const char*>(figures), sizeof figures);
    out.close();
    check_state();
  }

  std::string path;
  RunHead head;
  std::ofstream out;
  std::string lost;  // why; empty: nothing is
  RowCode row_code;
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context;
  std::vector<char> packed;
  std::uint64_t rows = 0;
  std::size_t in_frame = 0;  // bytes, before they are packed
};

MessageWriter::MessageWriter(const std::string& path, const RunHead& head)
    : inner_(std::make_unique<Inner>(path, head)) {}
MessageWriter::~MessageWriter() = default;
MessageWriter::MessageWriter(MessageWriter&&) noexcept = default;
MessageWriter& MessageWriter::operator=(MessageWriter&&) noexcept = default;

void MessageWriter::add(const io::Batch& batch) {
  inner_->add(batch.bytes().data(), batch.bytes().size());
}

void MessageWriter::add_row(std::int64_t t_ns, std::span<const double> values) {
  const auto code = inner_->row_code.code(values);
  const io::Header header{t_ns, io::Kind::signals, 0, 0, static_cast<std::uint32_t>(code.size())};
  inner_->add(&header, sizeof header);
  inner_->add(code.data(), code.size());
  ++inner_->rows;
}

const RunHead& MessageWriter::head() const {
  return inner_->head;
}
std::uint64_t MessageWriter::rows() const {
  return inner_->rows;
}

Result<Done> MessageWriter::finish() {
  inner_->close();
  if (inner_->lost.empty()) return Done{};
  std::error_code ignored;
  if (std::filesystem::is_regular_file(inner_->path, ignored) &&
      std::filesystem::file_size(inner_->path, ignored) <= sizeof(FileStart)) {
    std::filesystem::remove(inner_->path, ignored);
  }
  return Error{ErrorKind::host, inner_->path, "cannot be written: " + inner_->lost,
               "is the disk full?"};
}

}  // namespace whirl::results
