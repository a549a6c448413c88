// bxCAN's side towards its bus: what it offers, and what the registers make of what comes of it.
#include <utility>

#include "io_bridges/qemu/stm32/bxcan.hpp"
#include "io_bridges/qemu/stm32/bxcan_bits.hpp"

namespace whirl::stm32 {

using namespace bxcan;

void BxCan::leave(int idles) {
  leaving_ = true;
  if (idles == kAfterBusOff) init_acknowledged_ = false;  // BOFF says what it waits for
  set_bit_time();
  (loops_back() ? loop_ : *bus_).connect(station(), idles);
}

void BxCan::joined(Nanoseconds /*now*/) {
  leaving_ = init_acknowledged_ = false;
  note_levels();
  update_lines();
}

const io::CanFrame* BxCan::offered() {
  offered_ = next_mailbox();
  if (offered_ < 0 || (mcr_ & INRQ) != 0) return nullptr;
  out_ = frame_of(mailbox_[static_cast<std::size_t>(offered_)]);
  return &out_;
}

void BxCan::begun(Nanoseconds /*now*/) {
  in_flight_ = offered_;
}

void BxCan::sent(Nanoseconds /*now*/) {
  lec_ = 0;
  const int mailbox = std::exchange(in_flight_, -1);
  if (mailbox >= 0) finish(mailbox, TXOK);
  abort_in_flight_ = false;
  note_levels();
  enter_or_leave();
  update_lines();
}

void BxCan::lost_arbitration(Nanoseconds /*now*/) {
  attempt_failed(ALST);
}

// The request stays, unless it is to be tried once only or was aborted meanwhile.
void BxCan::attempt_failed(std::uint32_t why) {
  const int mailbox = std::exchange(in_flight_, -1);
  if (mailbox < 0) return;
  if (abort_in_flight_) {
    finish(mailbox, 0);
  } else if ((mcr_ & NART) != 0) {
    finish(mailbox, why);
  } else {
    const auto shift = 8 * static_cast<std::uint32_t>(mailbox);
    tsr_flags_ = (tsr_flags_ & ~((ALST | TERR) << shift)) | why << shift;
  }
  abort_in_flight_ = false;
  enter_or_leave();
  update_lines();
}

void BxCan::failed(io::CanError error, bool sending, Nanoseconds /*now*/) {
  lec_ = static_cast<std::uint32_t>(error);
  if ((ier_ & LECIE) != 0) msr_flags_ |= ERRI;
  note_levels();
  if (sending) attempt_failed(TERR);
  update_lines();
}

// A flag that has come up since the last time is an interrupt where it is enabled.
void BxCan::note_levels() {
  const std::uint32_t levels = esr() & (EWGF | EPVF | BOFF), risen = levels & ~levels_;
  levels_ = levels;
  if (((risen & EWGF) != 0 && (ier_ & EWGIE) != 0) ||
      ((risen & EPVF) != 0 && (ier_ & EPVIE) != 0) ||
      ((risen & BOFF) != 0 && (ier_ & BOFIE) != 0)) {
    msr_flags_ |= ERRI;
  }
}

void BxCan::bus_off(Nanoseconds /*now*/) {
  note_levels();
  if ((mcr_ & ABOM) != 0) leave(kAfterBusOff);
  update_lines();
}

void BxCan::finish(int mailbox, std::uint32_t outcome) {
  const auto n = static_cast<std::uint32_t>(mailbox);
  mailbox_[n].pending = false;
  mailbox_[n].word[0] &= ~TXRQ;
  tsr_flags_ = (tsr_flags_ & ~(0xFu << (8 * n))) | (RQCP | outcome) << (8 * n);
}

void BxCan::stirred(Nanoseconds /*now*/) {
  if (!sleeping_) return;
  msr_flags_ |= WKUI;
  if ((mcr_ & AWUM) != 0) {
    mcr_ &= ~SLEEP;
    enter_or_leave();
  }
  update_lines();
}

void BxCan::receive(const io::CanFrame& frame, Nanoseconds /*now*/) {
  lec_ = 0;
  note_levels();
  store(frame);
  update_lines();
}

}  // namespace whirl::stm32
