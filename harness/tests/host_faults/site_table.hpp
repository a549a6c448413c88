// What the processes of one run and the driver share: each site that calls the system, how often, and
// which one fails.
#pragma once
#include <atomic>
#include <cstdint>

namespace whirl::host_faults {

inline constexpr int kSites = 4096;
inline constexpr const char* kTableVariable = "WHIRL_SITES";  // the file that holds the table

struct Site {
  std::atomic<std::uint64_t> hash{0};  // of the call and of the way to it; 0: free
  std::atomic<std::uint32_t> count{0};
  std::atomic<std::uint32_t> first{0}, last{0};  // when, in calls of the whole run
  char call[16] = {};
};

struct SiteTable {
  std::atomic<std::uint32_t> calls{0};
  std::atomic<std::uint32_t> judged{
      0};  // the call at which the first result was opened; 0: none was
  // The fault: this occurrence of this site fails so. 0: none does.
  std::uint64_t site = 0;
  std::uint32_t occurrence = 0;
  std::int32_t error = 0;
  std::atomic<std::uint32_t> done{0};
  Site sites[kSites];
};

}  // namespace whirl::host_faults
