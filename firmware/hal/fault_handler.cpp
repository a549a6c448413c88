// HardFault (the other faults are left disabled and escalate to it): records the registers of the
// interrupted code, then resets. The motors stop by the ESCs' watchdogs at the latest.
#include "firmware/hal/fault_record.hpp"

#include "firmware/hal/core_registers.hpp"

__attribute__((section(".noinit"), used)) fw::FaultRecord fw_fault_record;

namespace {

// What the core stacks on exception entry, PM0214 2.3.7.
struct StackedFrame {
  std::uint32_t r0, r1, r2, r3, r12, lr, pc, xpsr;
};
constexpr std::uint32_t kExtendedFrame = 1u << 4;  // EXC_RETURN: 0 means floats were stacked too
constexpr std::uint32_t kAlignedStack = 1u << 9;   // stacked xPSR: a word of padding

}  // namespace

extern "C" __attribute__((noreturn, used)) void record_fault(const StackedFrame* frame,
                                                             const std::uint32_t* r4_to_r11,
                                                             std::uint32_t exc_return,
                                                             std::uint32_t frame_address) {
  fw::FaultRecord& record = fw_fault_record;
  record.r[0] = frame->r0;
  record.r[1] = frame->r1;
  record.r[2] = frame->r2;
  record.r[3] = frame->r3;
  for (unsigned i = 0; i < 8; ++i) record.r[4 + i] = r4_to_r11[i];
  record.r[12] = frame->r12;
  record.lr = frame->lr;
  record.pc = frame->pc;
  record.xpsr = frame->xpsr;
  record.sp = frame_address + ((exc_return & kExtendedFrame) != 0 ? 32u : 104u) +
              ((frame->xpsr & kAlignedStack) != 0 ? 4u : 0u);
  record.exception = 3;
  record.cfsr = fw::hw::SCB::CFSR::read();
  record.hfsr = fw::hw::SCB::HFSR::read();
  record.mmfar = fw::hw::SCB::MMFAR::read();
  record.bfar = fw::hw::SCB::BFAR::read();
  record.magic = fw::FaultRecord::kMagic;
  __asm volatile("dsb" ::: "memory");
  fw::hw::SCB::AIRCR::write(fw::hw::SCB::SYSRESETREQ);
  for (;;) {
  }
}

extern "C" __attribute__((naked, used)) void hard_fault_handler() {
  __asm volatile(
      "tst lr, #4       \n"
      "ite eq           \n"
      "mrseq r0, msp    \n"
      "mrsne r0, psp    \n"
      "mov r3, r0       \n"
      "push {r4-r11}    \n"
      "mov r1, sp       \n"
      "mov r2, lr       \n"
      "b record_fault   \n");
}
