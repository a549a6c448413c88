#include <zstd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include "results/messages/file_format.hpp"
#include "results/messages/message_file.hpp"
#include "results/messages/row_code.hpp"

namespace whirl::results {
namespace {

constexpr std::size_t kLargest_message = 64u << 20, kLargest_head = 16u << 20;
constexpr int kLargest_window_log = 27;  // what a damaged file may ask of the memory: 128 MB

}  // namespace

struct MessageReader::Inner {
  explicit Inner(const std::string& file_path)
      : path(file_path),
        in(file_path, std::ios::binary),
        context(ZSTD_createDCtx(), ZSTD_freeDCtx),
        packed(ZSTD_DStreamInSize()) {
    ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kLargest_window_log);
  }

  Error wrong(const std::string& what) const { return {ErrorKind::bad_input, path, what, ""}; }

  Result<Done> read_start() {
    FileStart start;
    const FileStart wanted;
    if (!in.read(reinterpret_cast<char*>(&start), sizeof start) ||
        std::memcmp(start.mark, wanted.mark, sizeof start.mark) != 0) {
      return wrong("is no file of a run's messages");
    }
    if (start.version != wanted.version) {
      return wrong("is of version " + std::to_string(start.version) +
                   " of the format; this whirl reads " + std::to_string(wanted.version));
    }
    if (start.head_size > kLargest_head) return wrong("is damaged: its head has no end");
    std::string text(start.head_size, '\0');
    if (!in.read(text.data(), static_cast<std::streamsize>(text.size()))) {
      return wrong("is cut off in its head");
    }
    read_B = sizeof start + text.size();
    auto read = read_head(text);
    if (!read) return wrong(read.error().what);
    head = std::move(read.value());
    if (start.rows != kUnknown) rows = start.rows;
    file_size = start.file_size;
    row.resize(head.columns.size());
    row_code.emplace(head.columns.size());
    return Done{};
  }

  // The next `size` bytes behind those that were taken; nothing: the file ends before them.
  Result<const std::uint8_t*> ahead(std::size_t size) {
    while (plain.size() - taken < size) {
      if (taken > 0) {
        plain.erase(plain.begin(), plain.begin() + static_cast<std::ptrdiff_t>(taken));
        taken = 0;
      }
      const auto more = unpack();
      if (!more) return more.error();
      if (!more.value()) return static_cast<const std::uint8_t*>(nullptr);
    }
    return plain.data() + taken;
  }

  // Some more of the stream, at the end of `plain`; false: there is none.
  Result<bool> unpack() {
    if (source.pos == source.size) {
      in.read(packed.data(), static_cast<std::streamsize>(packed.size()));
      source = {packed.data(), static_cast<std::size_t>(in.gcount()), 0};
      if (in.bad()) return wrong(std::string("cannot be read: ") + std::strerror(errno));
    }
    const std::size_t before = plain.size(), was = source.pos;
    plain.resize(before + ZSTD_DStreamOutSize());
    ZSTD_outBuffer to{plain.data() + before, plain.size() - before, 0};
    const bool fed = source.pos < source.size;
    const std::size_t status = ZSTD_decompressStream(context.get(), &to, &source);
    plain.resize(before + to.pos);
    read_B += source.pos - was;
    if (ZSTD_isError(status) != 0) {
      return wrong(std::string("is damaged: ") + ZSTD_getErrorName(status));
    }
    return fed || to.pos > 0;
  }

  // Of a run that came to its end the file says how much there is.
  Result<Next> end() const {
    if (!rows || (rows_read == *rows && read_B == file_size && taken == plain.size())) {
      return Next::end;
    }
    return wrong("is damaged: " + std::to_string(rows_read) + " of " + std::to_string(*rows) +
                 " rows are there, " + std::to_string(read_B) + " of " + std::to_string(file_size) +
                 " bytes");
  }

  std::string path;
  std::ifstream in;
  RunHead head;
  std::optional<std::uint64_t> rows;
  std::uint64_t file_size = kUnknown, read_B = 0, rows_read = 0;
  std::optional<RowCode> row_code;
  std::vector<double> row;
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context;
  std::vector<char> packed;
  ZSTD_inBuffer source{nullptr, 0, 0};
  std::vector<std::uint8_t> plain;
  std::size_t taken = 0;
  io::Reader message{{}};
};

MessageReader::MessageReader(std::unique_ptr<Inner> inner) : inner_(std::move(inner)) {}
MessageReader::~MessageReader() = default;
MessageReader::MessageReader(MessageReader&&) noexcept = default;
MessageReader& MessageReader::operator=(MessageReader&&) noexcept = default;

Result<MessageReader> MessageReader::open(const std::string& path) {
  auto inner = std::make_unique<Inner>(path);
  if (!inner->in) return inner->wrong(std::string("cannot be opened: ") + std::strerror(errno));
  if (auto read = inner->read_start(); !read) return read.error();
  return MessageReader(std::move(inner));
}

const RunHead& MessageReader::head() const {
  return inner_->head;
}
std::optional<std::uint64_t> MessageReader::rows() const {
  return inner_->rows;
}
const io::Reader& MessageReader::message() const {
  return inner_->message;
}
std::span<const double> MessageReader::row() const {
  return inner_->row;
}

Result<MessageReader::Next> MessageReader::next() {
  Inner& i = *inner_;
  const auto begin = i.ahead(sizeof(io::Header));
  if (!begin) return begin.error();
  if (begin.value() == nullptr) return i.end();
  io::Header header;
  std::memcpy(&header, begin.value(), sizeof header);
  if (header.size > kLargest_message) return i.wrong("is damaged: a message has no end");
  const std::size_t size = sizeof header + header.size;
  const auto whole = i.ahead(size);
  if (!whole) return whole.error();
  if (whole.value() == nullptr) return i.end();
  i.message = io::Reader({whole.value(), size});
  i.message.next();
  i.taken += size;
  if (header.kind != io::Kind::signals) {
    if (header.board < i.head.nodes.size()) return Next::message;
    return i.wrong("is damaged: a message of a board that is not there");
  }
  if (header.size != i.row.size() * 8) return i.wrong("is damaged: a row of another length");
  i.row_code->decode(i.message.payload(), i.row);
  ++i.rows_read;
  return Next::row;
}

}  // namespace whirl::results
