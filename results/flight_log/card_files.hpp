// The logs in the image of a card: files of the root directory of its FAT32 volume. Reads only.
//
//   Volume   the first FAT32 partition (0x0B, 0x0C), or one that begins at block 0; sectors of 512 bytes
//   Files    LOGnnnnn.ULG by their directory entries' size and their chain in the first FAT. What the
//            chain does not reach is not there, as for a PC
//   Source   Microsoft FAT32 File System Specification 1.03
//   Errors   bad_input: no such volume, or chains and entries that lead out of it
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::results {

struct CardFile {
  std::string name;  // "LOG00001.ULG"
  std::vector<std::uint8_t> bytes;
};

// In the order of their names. None: an empty list.
Result<std::vector<CardFile>> logs_on_card(const std::string& image_path);

}  // namespace whirl::results
