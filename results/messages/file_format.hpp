// The first bytes of a file of messages: see message_file.hpp.
#pragma once
#include <cstdint>

namespace whirl::results {

inline constexpr std::uint64_t kUnknown = UINT64_MAX;

struct FileStart {
  char mark[8] = {'W', 'H', 'I', 'R', 'L', 'M', 'S', 'G'};
  std::uint32_t version = 1;
  std::uint32_t head_size = 0;
  std::uint64_t rows = kUnknown;
  std::uint64_t file_size = kUnknown;
};
static_assert(sizeof(FileStart) == 32);

}  // namespace whirl::results
