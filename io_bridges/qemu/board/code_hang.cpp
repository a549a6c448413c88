#include "io_bridges/qemu/board/code_hang.hpp"

namespace whirl::board {
namespace {

constexpr std::uint16_t kBranchToItself = 0xE7FE;

}  // namespace

CodeHangs::Hang::Hang(CodeHangs& owner, std::uint32_t number, std::uint32_t address)
    : begin(owner.events_,
            [this, &owner, number, address] {
              owner.emulator_.peek(address, &code, sizeof code);
              owner.emulator_.write_cells(address, &kBranchToItself, sizeof kBranchToItself);
              owner.happened_.add(io::Kind::fault_applied, static_cast<std::uint16_t>(number),
                                  owner.events_.now(), nullptr, 0);
            }),
      end(owner.events_,
          [this, &owner, address] { owner.emulator_.write_cells(address, &code, sizeof code); }) {}

void CodeHangs::add(const io::FaultCommand& fault, const std::vector<const Symbol*>& functions) {
  for (const Symbol* function : functions) {
    Hang& hang = hangs_.emplace_back(*this, fault.number, function->address);
    hang.begin.at(fault.start_ns);
    if (fault.end_ns != io::kNever) hang.end.at(fault.end_ns);
  }
}

}  // namespace whirl::board
