// The vector table in RAM: an interrupt's address is read without the flash's wait states.
#pragma once

namespace fw::pod {

void move_vectors_to_ram();

}  // namespace fw::pod
