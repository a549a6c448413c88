#include "io_bridges/qemu/stm32/rcc.hpp"

#include <cmath>
#include <cstdio>

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t CR = 0x00;
constexpr std::uint32_t HSION = 1u << 0, HSIRDY = 1u << 1, HSEON = 1u << 16, HSERDY = 1u << 17,
                        CSSON = 1u << 19, PLLON = 1u << 24, PLLRDY = 1u << 25, PLLI2SON = 1u << 26,
                        PLLI2SRDY = 1u << 27;
constexpr std::uint32_t kCrReady = HSIRDY | HSERDY | PLLRDY | PLLI2SRDY, kHsiCal = 0xFF00;
// CIR flags, in the order of their bits
constexpr std::uint32_t LSIRDYF = 1u << 0, LSERDYF = 1u << 1, HSIRDYF = 1u << 2, HSERDYF = 1u << 3,
                        PLLRDYF = 1u << 4, PLLI2SRDYF = 1u << 5, CSSF = 1u << 7;
// BDCR, CSR
constexpr std::uint32_t LSEON = 1u << 0, LSERDY = 1u << 1, LSEBYP = 1u << 2, RTCEN = 1u << 15,
                        BDRST = 1u << 16, RTCSEL = 3u << 8;
constexpr std::uint32_t LSION = 1u << 0, LSIRDY = 1u << 1, RMVF = 1u << 24, PINRSTF = 1u << 26,
                        SFTRSTF = 1u << 28, IWDGRSTF = 1u << 29, WWDGRSTF = 1u << 30,
                        LPWRRSTF = 1u << 31;

constexpr Nanoseconds kHsiStart_ns = 2'200, kPllLock_ns = 200'000, kLsiStart_ns = 30'000,
                      kLseStart_ns = 2'000'000'000;
// Firmware that means to use its crystal does so soon after it is ready, and soon after reset.
constexpr Nanoseconds kCrystal_idle_ns = 10'000'000, kReset_clock_ns = 100'000'000;
constexpr double kHeld_in_reset_V = 1.6;  // below it, by both parts' data sheets

std::string megahertz(double frequency_Hz) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g MHz", frequency_Hz * 1e-6);
  return text;
}

// An internal reset pulls NRST too.
std::uint32_t cause_bits(ResetCause cause, std::uint32_t power_on) {
  switch (cause) {
    case ResetCause::power_on:
      return power_on;
    case ResetCause::pin:
      return PINRSTF;
    case ResetCause::software:
      return SFTRSTF | PINRSTF;
    case ResetCause::independent_watchdog:
      return IWDGRSTF | PINRSTF;
    case ResetCause::window_watchdog:
      return WWDGRSTF | PINRSTF;
    case ResetCause::low_power:
      return LPWRRSTF | PINRSTF;
  }
  return 0;
}

}  // namespace

double ahb_divisor(std::uint32_t hpre) {
  static constexpr int kShift[8] = {1, 2, 3, 4, 6, 7, 8, 9};  // there is no /32
  return hpre < 8 ? 1.0 : std::ldexp(1.0, kShift[hpre - 8]);
}
double apb_divisor(std::uint32_t ppre) {
  return ppre < 4 ? 1.0 : std::ldexp(1.0, static_cast<int>(ppre) - 3);
}

Rcc::Rcc(const RccSetup& setup, const RccLayout& layout)
    : WordBlock("RCC", Narrow::merge),
      layout_(layout),
      hse_Hz_(setup.hse_Hz),
      lse_Hz_(setup.lse_Hz),
      hse_start_ns_(setup.hse_start_ns),
      hsi_error_(setup.hsi_error),
      hse_error_(setup.hse_error),
      events_(setup.events),
      interrupts_(setup.interrupts),
      finding_(setup.finding),
      hsi_ready_(events_, [this] { became_ready(CR, HSIRDY, HSIRDYF); }),
      hse_ready_(events_, [this] { became_ready(CR, HSERDY, HSERDYF); }),
      pll_ready_(events_, [this] { became_ready(CR, PLLRDY, PLLRDYF); }),
      plli2s_ready_(events_, [this] { became_ready(CR, PLLI2SRDY, PLLI2SRDYF); }),
      lsi_ready_(events_, [this] { became_ready(layout_.csr, LSIRDY, LSIRDYF); }),
      lse_ready_(events_, [this] { became_ready(layout_.bdcr, LSERDY, LSERDYF); }),
      crystal_unused_(events_, [this] { report_unused_crystal(); }),
      still_reset_clock_(events_, [this] { report_reset_clock(); }) {}

void Rcc::on_block_reset(std::uint32_t offset, std::uint32_t mask, std::function<void()> reset) {
  reset_lines_.push_back({offset, mask, std::move(reset)});
}

void Rcc::reset() {
  for (io::Event* e : {&hsi_ready_, &hse_ready_, &pll_ready_, &plli2s_ready_, &crystal_unused_}) {
    e->cancel();
  }
  still_reset_clock_.in(kReset_clock_ns);
  const std::uint32_t backup = word(layout_.bdcr), status = word(layout_.csr);
  words_.fill(0);
  word(CR) = 0x8000 | 0x80 | HSION | HSIRDY;  // HSICAL is a factory value
  set_reset_values();
  word(layout_.bdcr) = backup;  // the backup domain outlives a system reset
  word(layout_.csr) = status;
  update_irq();
  update_clocks();
}

void Rcc::system_reset(ResetCause cause) {
  if (cause == ResetCause::power_on) {
    word(layout_.bdcr) = 0;
    word(layout_.csr) = 0;
    lse_ready_.cancel();
    lsi_ready_.cancel();
    if (backup_reset_) backup_reset_();
  }
  word(layout_.csr) |= cause_bits(cause, layout_.power_on_causes);
  reset();
}

std::uint32_t Rcc::read_word(std::uint32_t offset) {
  return offset < words_.size() * 4 ? word(offset) : 0;
}

void Rcc::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset >= words_.size() * 4) return;
  if (offset >= layout_.first_reset && offset <= layout_.last_reset) {
    return write_reset_register(offset, value);
  }
  if (offset == CR) return write_cr(value);
  if (offset == layout_.cfgr) return write_cfgr(value);
  if (offset == layout_.cir) return write_cir(value);
  if (offset == layout_.bdcr) return write_bdcr(value);
  if (offset == layout_.csr) return write_csr(value);
  write_other(offset, value);
}

// An oscillator was switched on or off. Ready comes after its start-up time.
void Rcc::start(io::Event& ready, Nanoseconds delay, std::uint32_t offset, std::uint32_t on_bit,
                std::uint32_t before, std::uint32_t after, bool fitted) {
  const bool was = (before & on_bit) != 0, is = (after & on_bit) != 0;
  if (was == is) return;
  if (is) {
    if (fitted) ready.in(delay);
    return;
  }
  ready.cancel();
  word(offset) &= ~(on_bit << 1);  // every ready bit sits one above its on bit
}

void Rcc::write_cr(std::uint32_t value) {
  const std::uint32_t before = word(CR);
  std::uint32_t on = value & layout_.cr_writable;
  // What drives SYSCLK cannot be switched off.
  if (sws() == pll) on |= PLLON | (pll_from_hse() ? HSEON : HSION);
  if (sws() == hse) on |= HSEON;
  if (sws() == hsi) on |= HSION;
  if ((before & CSSON) != 0) on |= CSSON;  // cleared by reset only (or by the failure itself)
  word(CR) = (before & (kCrReady | kHsiCal)) | on;
  start(hsi_ready_, kHsiStart_ns, CR, HSION, before, on, true);
  start(hse_ready_, hse_start_ns_, CR, HSEON, before, on, hse_Hz_ > 0.0);
  const bool locks = (on & ~before & PLLON) == 0 || pll_can_lock();
  start(pll_ready_, kPllLock_ns, CR, PLLON, before, on, locks);
  start(plli2s_ready_, kPllLock_ns, CR, PLLI2SON, before, on, true);
  watch_crystal(before, on);
}

// Firmware that waits too shortly for its crystal goes on at the speed of HSI, and mostly says nothing.
void Rcc::watch_crystal(std::uint32_t before, std::uint32_t after) {
  if ((before & HSERDY) != 0) return;
  const std::uint32_t rising = after & ~before;
  if ((rising & HSEON) != 0 && hse_Hz_ <= 0.0) {
    report_once(64, "HSE was switched on, but the board has no crystal: it will not become ready");
  }
  const bool off = (before & ~after & HSEON) != 0;
  const bool without = (before & HSEON) != 0 && (rising & PLLON) != 0 && !pll_from_hse();
  if (!off && !without) return;
  report_once(128, std::string("the crystal was given up: ") +
                       (off ? "HSE was switched off" : "the PLL was started from HSI") +
                       " before HSE was ready, which takes " +
                       std::to_string(hse_start_ns_ / 1000) + " us on this board");
}

void Rcc::report_unused_crystal() {
  if ((word(CR) & HSERDY) == 0 || runs_from_hse()) return;
  report_once(128, "the crystal was given up: HSE has been ready for 10 ms, but SYSCLK is " +
                       megahertz(sysclk_Hz_) + " from HSI");
}

void Rcc::report_reset_clock() {
  if (sws() != hsi || vdd_V_ < kHeld_in_reset_V) return;  // held in reset: nothing runs
  report_once(256, "100 ms after its reset the core still runs from its reset clock, HSI of " +
                       megahertz(layout_.hsi_Hz));
}

void Rcc::write_cfgr(std::uint32_t value) {
  word(layout_.cfgr) = (value & ~0xCu) | (word(layout_.cfgr) & 0xC);
  try_switch();
  update_clocks();
}

// SW asks, SWS follows as soon as the wanted source is ready.
void Rcc::try_switch() {
  const std::uint32_t wanted = word(layout_.cfgr) & 3;
  static constexpr std::uint32_t kReady[4] = {HSIRDY, HSERDY, PLLRDY, 0};
  if ((word(CR) & kReady[wanted]) == 0) return;
  word(layout_.cfgr) = (word(layout_.cfgr) & ~0xCu) | (wanted << 2);
}

void Rcc::became_ready(std::uint32_t offset, std::uint32_t ready_bit, std::uint32_t flag) {
  word(offset) |= ready_bit;
  word(layout_.cir) |= flag;
  if (flag == HSERDYF) crystal_unused_.in(kCrystal_idle_ns);
  try_switch();
  update_irq();
  update_clocks();
}

void Rcc::write_cir(std::uint32_t value) {
  const std::uint32_t clear = (value >> 16) & 0xBF;
  word(layout_.cir) = (value & 0x3F00) | (word(layout_.cir) & 0xBF & ~clear);
  if ((clear & CSSF) != 0 && nmi_) nmi_(false);
  update_irq();
}

void Rcc::update_irq() {
  constexpr int kRccIrq = 5;
  const std::uint32_t cir = word(layout_.cir);
  interrupts_.set(kRccIrq, ((cir >> 8) & cir & 0x3F) != 0);
}

void Rcc::write_bdcr(std::uint32_t value) {
  if (backup_writable_ && !backup_writable_()) return;  // PWR_CR.DBP protects the domain
  const std::uint32_t before = word(layout_.bdcr);
  if ((value & BDRST) != 0) {
    word(layout_.bdcr) = BDRST;
    lse_ready_.cancel();
    if (backup_reset_ && (before & BDRST) == 0) backup_reset_();
    return update_clocks();
  }
  // RTCSEL can be chosen once; only a backup domain reset frees it.
  const std::uint32_t select = (before & RTCSEL) != 0 ? before & RTCSEL : value & RTCSEL;
  word(layout_.bdcr) = (value & (LSEON | LSEBYP | RTCEN)) | select | (before & LSERDY);
  start(lse_ready_, kLseStart_ns, layout_.bdcr, LSEON, before, value, lse_Hz_ > 0.0);
  update_clocks();
}

void Rcc::write_csr(std::uint32_t value) {
  const std::uint32_t before = word(layout_.csr);
  const std::uint32_t flags = (value & RMVF) != 0 ? 0 : before & 0xFE000000;
  word(layout_.csr) = flags | (value & LSION) | (before & LSIRDY);
  start(lsi_ready_, kLsiStart_ns, layout_.csr, LSION, before, value, true);
}

void Rcc::write_reset_register(std::uint32_t offset, std::uint32_t value) {
  const std::uint32_t rising = value & ~word(offset);
  word(offset) = value;
  if (rising == 0) return;
  for (const ResetLine& line : reset_lines_) {
    if (line.offset == offset && (line.mask & rising) != 0) line.reset();
  }
}

double Rcc::rtc_Hz() const {
  const std::uint32_t bdcr = word(layout_.bdcr);
  if ((bdcr & RTCEN) == 0) return 0.0;
  switch ((bdcr & RTCSEL) >> 8) {
    case 1:
      return (bdcr & LSERDY) != 0 ? lse_Hz_ : 0.0;
    case 2:
      return (word(layout_.csr) & LSIRDY) != 0 ? lsi_Hz() : 0.0;
    case 3:
      return (word(CR) & HSERDY) != 0 ? rtc_from_hse_Hz() * (1.0 + hse_error_) : 0.0;
    default:
      return 0.0;
  }
}

void Rcc::update_clocks() {
  const ClockTree tree = clock_tree();
  sysclk_Hz_ = tree.sysclk_Hz * (1.0 + oscillator_error());
  hclk_Hz_ = sysclk_Hz_ / tree.ahb;
  pclk1_Hz_ = hclk_Hz_ / tree.apb1;
  pclk2_Hz_ = hclk_Hz_ / tree.apb2;
  timclk1_Hz_ = tree.apb1 > 1.0 ? 2 * pclk1_Hz_ : pclk1_Hz_;
  timclk2_Hz_ = tree.apb2 > 1.0 ? 2 * pclk2_Hz_ : pclk2_Hz_;
  constexpr double kSlack = 1.00001;
  const auto above = [this](double real_Hz, double limit_Hz) {
    return nominal_Hz(real_Hz) > kSlack * limit_Hz;
  };
  if (above(sysclk_Hz_, layout_.max_sysclk_Hz)) report_once(1, "SYSCLK above the part's limit");
  if (above(pclk1_Hz_, layout_.max_pclk1_Hz)) report_once(2, "PCLK1 above the part's limit");
  if (above(pclk2_Hz_, layout_.max_pclk2_Hz)) report_once(4, "PCLK2 above the part's limit");
  for (const auto& listener : listeners_) listener();
}

void Rcc::report_once(std::uint32_t bit, const std::string& what) {
  if ((reported_ & bit) != 0 || !finding_) return;
  reported_ |= bit;
  finding_({events_.now(), "RCC", what});
}

void Rcc::fail_hse() {
  hse_ready_.cancel();
  word(CR) &= ~HSERDY;
  const bool lost = runs_from_hse();
  if (pll_from_hse()) word(CR) &= ~PLLRDY;
  if ((word(CR) & CSSON) == 0) return;  // without CSS the part simply stops; not modelled
  word(CR) &= ~(HSEON | CSSON | (pll_from_hse() ? PLLON : 0));
  word(CR) |= HSION | HSIRDY;
  if (lost) word(layout_.cfgr) &= ~0xFu;
  word(layout_.cir) |= CSSF;
  update_clocks();
  if (nmi_) nmi_(true);
}

}  // namespace whirl::stm32
