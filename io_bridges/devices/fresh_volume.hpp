// A freshly formatted card: one FAT32 volume in a new part's memory, as a camera or a PC leaves it.
//
//   Layout   master boot record with one partition of type 0x0C from 1 MiB on; in it boot sector and
//            FSInfo with their backups, 32 reserved sectors, two FATs, an empty root directory
//   Clusters 512 bytes to 260 MiB, 4 KiB to 8 GiB, 32 KiB beyond: FAT32 begins at 65525 clusters
//   Source   Microsoft FAT32 File System Specification 1.03; facts of the layout: [FAT 1.03] pp. 7-23
//   Error    fsck.fat and mtools find nothing wrong with it (tests/fresh_volume_test.cpp)
//   Left out volumes below 64 MiB, which would be FAT16
//   Same     the bytes depend on size and serial number only: no clock, no name of the host
#pragma once
#include <cstdint>

#include "io_bridges/devices/memory_file.hpp"

namespace whirl::io {

inline constexpr std::int64_t kLeast_volume_bytes = 64LL * 1024 * 1024;

// Pre: the memory is all zero, at least kLeast_volume_bytes, at most 2 TiB.
void write_fresh_volume(MemoryFile& memory, std::uint32_t serial);

inline constexpr std::int64_t kMost_filled_bytes = 4LL << 30;  // FAT has no larger file

// Of a fresh volume: all but the last free_bytes, rounded up to whole clusters, becomes one file FULL.BIN.
// Pre: a fresh volume of at most kMost_filled_bytes.
void fill_fresh_volume(MemoryFile& memory, std::int64_t free_bytes);

}  // namespace whirl::io
