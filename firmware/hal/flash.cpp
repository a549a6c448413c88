#include "firmware/hal/flash.hpp"

#include "firmware/hal/registers.hpp"

extern "C" volatile std::uint32_t parameter_flash[];  // placed by the linker script

namespace fw::hal {

using namespace hw;

constinit ParameterSectors parameter_sectors;

namespace {

constexpr std::uint32_t kFirstSector = 1;  // of those two, as the FLASH interface counts
constexpr int kPolls = 20'000'000;         // a second at least, of eight cycles each

class Unlocked {
 public:
  Unlocked() {
    FLASH::KEYR::write(FLASH::KEY1);
    FLASH::KEYR::write(FLASH::KEY2);
    FLASH::SR::write(FLASH::all_errors);  // an old one would block what comes
  }
  ~Unlocked() { FLASH::CR::write(FLASH::LOCK); }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;
};

Status wait_done() {
  for (int i = 0; i < kPolls; ++i) {
    const std::uint32_t status = FLASH::SR::read();
    if ((status & FLASH::BSY) != 0) continue;
    FLASH::SR::write(FLASH::all_errors);
    return (status & FLASH::all_errors) == 0 ? Status::ok : Status::bad_data;
  }
  return Status::no_answer;
}

// It may still hold what was erased.
void flush_data_cache() {
  FLASH::ACR::clear(FLASH::DCEN);
  FLASH::ACR::set(FLASH::DCRST);
  FLASH::ACR::clear(FLASH::DCRST);
  FLASH::ACR::set(FLASH::DCEN);
}

}  // namespace

std::uint32_t ParameterSectors::read(unsigned sector, std::uint32_t word) const {
  return parameter_flash[sector * kWords + word];
}

Status ParameterSectors::program(unsigned sector, std::uint32_t word, std::uint32_t value) {
  const Unlocked unlocked;
  FLASH::CR::write(FLASH::PSIZE_x32 | FLASH::PG);
  parameter_flash[sector * kWords + word] = value;
  __asm volatile("dsb" ::: "memory");
  return wait_done();
}

Status ParameterSectors::erase(unsigned sector) {
  const Unlocked unlocked;
  const std::uint32_t setup = FLASH::PSIZE_x32 | FLASH::SER | FLASH::SNB(kFirstSector + sector);
  FLASH::CR::write(setup);
  FLASH::CR::write(setup | FLASH::STRT);
  __asm volatile("dsb" ::: "memory");
  const Status done = wait_done();
  flush_data_cache();
  return done;
}

}  // namespace fw::hal
