// The fields of a message, for one layout that serves both ways: a message's layout() is run with a writer
// (encode) or a reader (decode).
//
//   template <typename F> void layout(F& f) { f.u(uptime_s, 32); f.f16(voltage_V); f.tail(commands, ...); }
//
//   Saturation  an integer beyond its width is clamped when it is written (DSDL: saturated), but by u_cut,
//               which keeps the low bits (DSDL: truncated)
//   Decoding    refuses what is too short, what is a whole byte or more too long, and lengths beyond the type's
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <type_traits>

#include "io_bridges/protocols/dronecan/bits.hpp"
#include "io_bridges/protocols/dronecan/float16.hpp"

namespace whirl::io::dronecan {

// An array of at most N items.
template <typename T, std::size_t N>
struct Bounded {
  std::size_t size = 0;
  std::array<T, N> items{};

  static constexpr std::size_t kMost = N;
  void add(const T& item) {
    if (size < N) items[size++] = item;
  }
  std::span<const T> all() const { return std::span(items).first(size); }
  bool operator==(const Bounded& other) const {
    return std::equal(all().begin(), all().end(), other.all().begin(), other.all().end());
  }
};

template <typename Stream>
class Fields {
 public:
  explicit Fields(Stream& stream) : stream_(stream) {}

  template <typename T>
  void u(T& value, int width) {
    if constexpr (Stream::kReads) {
      value = static_cast<T>(stream_.bits(width));
    } else {
      const std::uint64_t most = width == 64 ? ~0ull : (1ull << width) - 1;
      stream_.bits(std::min(static_cast<std::uint64_t>(value), most), width);
    }
  }
  template <typename T>
  void u_cut(T& value, int width) {
    if constexpr (Stream::kReads) {
      value = static_cast<T>(stream_.bits(width));
    } else {
      stream_.bits(static_cast<std::uint64_t>(value), width);
    }
  }
  template <typename T>
  void i(T& value, int width) {
    if constexpr (Stream::kReads) {
      const int unused = 64 - width;
      value = static_cast<T>(static_cast<std::int64_t>(stream_.bits(width) << unused) >> unused);
    } else {
      const std::int64_t most = static_cast<std::int64_t>((1ull << (width - 1)) - 1);
      const auto wide = std::clamp<std::int64_t>(value, -most - 1, most);
      stream_.bits(static_cast<std::uint64_t>(wide), width);
    }
  }
  void f16(float& value) {
    if constexpr (Stream::kReads) {
      value = from_float16(static_cast<std::uint16_t>(stream_.bits(16)));
    } else {
      stream_.bits(to_float16(value), 16);
    }
  }
  void f32(float& value) {
    if constexpr (Stream::kReads) {
      value = std::bit_cast<float>(static_cast<std::uint32_t>(stream_.bits(32)));
    } else {
      stream_.bits(std::bit_cast<std::uint32_t>(value), 32);
    }
  }
  void f16(std::array<float, 3>& values) {
    for (float& value : values) f16(value);
  }
  void f32(std::array<float, 3>& values) {
    for (float& value : values) f32(value);
  }
  void skip(int width) {
    std::uint64_t nothing = 0;
    u_cut(nothing, width);
  }

  // An array with its length before it.
  template <typename T, std::size_t N, typename Item>
  void array(Bounded<T, N>& values, int length_width, Item item) {
    u(values.size, length_width);
    if (values.size > N) return reject(values);
    for (std::size_t n = 0; n < values.size; ++n) item(values.items[n]);
  }
  // The last of a message: as many as are left.
  template <typename T, std::size_t N, typename Item>
  void tail(Bounded<T, N>& values, int item_width, Item item) {
    if constexpr (Stream::kReads) {
      values.size = stream_.left() / static_cast<std::size_t>(item_width);
      if (values.size > N) return reject(values);
    }
    for (std::size_t n = 0; n < values.size; ++n) item(values.items[n]);
  }
  // The last of a message: there, or not; as long as least_width if it is.
  bool is_there(std::uint8_t& count, int least_width) {
    if constexpr (Stream::kReads) {
      count = stream_.ok() && stream_.left() >= static_cast<std::size_t>(least_width) ? 1 : 0;
    }
    return count != 0;
  }
  void reject() {
    if constexpr (Stream::kReads) stream_.reject();
  }

 private:
  template <typename T, std::size_t N>
  void reject(Bounded<T, N>& values) {
    values.size = 0;
    reject();
  }

  Stream& stream_;
};

template <typename Message>
Payload encode(Message message) {
  Payload payload;
  BitWriter stream(payload);
  Fields fields(stream);
  message.layout(fields);
  stream.close();
  return payload;
}

template <typename Message>
std::optional<Message> decode(std::span<const std::uint8_t> bytes) {
  Message message;
  BitReader stream(bytes);
  Fields fields(stream);
  message.layout(fields);
  if (!stream.ok() || stream.left() >= 8) return std::nullopt;
  return message;
}

}  // namespace whirl::io::dronecan
