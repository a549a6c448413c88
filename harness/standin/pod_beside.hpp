// A flight controller's board whose sensors and ESCs the pod plays, on a board of its own: the two are joined as the pod's
// pins ask for (docs/pod.md), byte by byte in virtual time. Of metal this is what a pod's host finds.
#pragma once
#include <memory>
#include <string>

#include "harness/target/target.hpp"
#include "io_bridges/board_description/board_description.hpp"

namespace whirl {

struct PodBeside {
  BoardDescription flight, pod;  // as their files have them
  std::string flight_image, pod_image;
};

// Boards 0 and 1 of the target. Errors  host: no memory for the wire
Result<std::unique_ptr<Target>> with_pod(const PodBeside& boards);

}  // namespace whirl
