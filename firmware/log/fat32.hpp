// Where things are on a FAT32 volume: the arithmetic of its boot sector, FAT and directory entries.
//
//   Source  Microsoft FAT32 File System Specification 1.03
//   Valid   sectors of 512 bytes; a volume that begins at block 0, or in the first partition of a master
//           boot record with type 0x0B or 0x0C
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace fw::fat32 {

inline constexpr std::size_t kSector_bytes = 512;
inline constexpr std::uint32_t kEntries_per_sector = 128, kSlots_per_sector = 16;
inline constexpr std::uint32_t kEnd = 0x0FFFFFFF, kMask = 0x0FFFFFFF, kLeast_end = 0x0FFFFFF8;
inline constexpr std::uint32_t kUnknown = 0xFFFFFFFF, kInfo_signature = 0x41615252;
using Sector = std::array<std::uint8_t, kSector_bytes>;

inline std::uint32_t get(const Sector& s, std::size_t at, unsigned bytes) {
  std::uint32_t value = 0;
  for (unsigned i = bytes; i-- > 0;) value = value << 8 | s[at + i];
  return value;
}
inline void put(Sector& s, std::size_t at, unsigned bytes, std::uint32_t value) {
  for (unsigned i = 0; i < bytes; ++i, value >>= 8) s[at + i] = static_cast<std::uint8_t>(value);
}

inline bool has_signature(const Sector& s) {
  return s[510] == 0x55 && s[511] == 0xAA;
}

struct Volume {
  std::uint32_t info = 0;  // block of FSInfo; 0: none
  std::uint32_t fat = 0;   // first block of the first FAT
  std::uint32_t fat_sectors = 0, fats = 0;
  std::uint32_t data = 0;  // block of cluster 2
  std::uint32_t sectors_per_cluster = 0;
  std::uint32_t clusters = 0;
  std::uint32_t root = 0;  // cluster

  std::uint32_t block_of(std::uint32_t cluster) const {
    return data + (cluster - 2) * sectors_per_cluster;
  }
  std::uint32_t end_cluster() const { return clusters + 2; }
};

// False: no FAT32 volume begins with that sector, which is block `base`.
inline bool read_boot(const Sector& s, std::uint32_t base, Volume& v) {
  if (!has_signature(s) || get(s, 11, 2) != kSector_bytes) return false;
  if (get(s, 17, 2) != 0 || get(s, 22, 2) != 0) return false;  // FAT12 and FAT16 have these
  v.sectors_per_cluster = s[13];
  v.fats = s[16];
  v.fat_sectors = get(s, 36, 4);
  v.root = get(s, 44, 4);
  const std::uint32_t reserved = get(s, 14, 2), total = get(s, 32, 4);
  const std::uint32_t before = reserved + v.fats * v.fat_sectors;
  if (v.sectors_per_cluster == 0 || v.fats == 0 || v.fat_sectors == 0 || before >= total)
    return false;
  v.fat = base + reserved;
  v.data = base + before;
  v.clusters =
      std::min((total - before) / v.sectors_per_cluster, v.fat_sectors * kEntries_per_sector - 2);
  const std::uint32_t info = get(s, 48, 2);
  v.info = info == 0 || info >= reserved ? 0 : base + info;
  return v.root >= 2 && v.root < v.end_cluster();
}

// The first block of the first FAT32 partition; 0: none.
inline std::uint32_t partition_of(const Sector& s) {
  if (!has_signature(s)) return 0;
  for (std::size_t at = 446; at < 510; at += 16) {
    if (s[at + 4] == 0x0B || s[at + 4] == 0x0C) return get(s, at + 8, 4);
  }
  return 0;
}

inline std::uint32_t fat_entry(const Sector& s, std::uint32_t cluster) {
  return get(s, 4 * (cluster % kEntries_per_sector), 4) & kMask;
}
inline void put_fat_entry(Sector& s, std::uint32_t cluster,
                          std::uint32_t next) {  // upper 4 bits stay
  const std::size_t at = 4 * (cluster % kEntries_per_sector);
  put(s, at, 4, (get(s, at, 4) & ~kMask) | next);
}

// LOG00001.ULG to LOG99999.ULG; 0: another name.
inline std::uint32_t log_number(const Sector& s, std::uint32_t slot) {
  const std::size_t at = 32 * slot;
  constexpr std::uint8_t kExtension[] = {'U', 'L', 'G'}, kName[] = {'L', 'O', 'G'};
  if (!std::equal(kName, kName + 3, s.begin() + static_cast<std::ptrdiff_t>(at)) ||
      !std::equal(kExtension, kExtension + 3, s.begin() + static_cast<std::ptrdiff_t>(at) + 8)) {
    return 0;
  }
  std::uint32_t number = 0;
  for (std::size_t i = 3; i < 8; ++i) {
    if (s[at + i] < '0' || s[at + i] > '9') return 0;
    number = 10 * number + (s[at + i] - std::uint32_t{'0'});
  }
  return number;
}

struct LogFile {
  std::uint32_t number = 0, first_cluster = 0, size_bytes = 0;
  std::uint16_t date = 0x0021, time = 0;  // FAT's; 1980-01-01
};

inline void put_log_entry(Sector& s, std::uint32_t slot, const LogFile& file) {
  const std::size_t at = 32 * slot;
  constexpr std::uint8_t kName[] = {'L', 'O', 'G', '0', '0', '0', '0', '0', 'U', 'L', 'G', 0x20};
  std::fill_n(s.begin() + static_cast<std::ptrdiff_t>(at), 32, std::uint8_t{0});
  std::copy(kName, kName + 12, s.begin() + static_cast<std::ptrdiff_t>(at));
  std::uint32_t rest = file.number;
  for (std::size_t i = 7; i >= 3; --i, rest /= 10) {
    s[at + i] = static_cast<std::uint8_t>('0' + rest % 10);
  }
  for (const std::size_t time_at : {at + 14, at + 22}) {
    put(s, time_at, 2, file.time);
    put(s, time_at + 2, 2, file.date);
  }
  put(s, at + 18, 2, file.date);
  put(s, at + 20, 2, file.first_cluster >> 16);
  put(s, at + 26, 2, file.first_cluster & 0xFFFF);
  put(s, at + 28, 4, file.size_bytes);
}

}  // namespace fw::fat32
