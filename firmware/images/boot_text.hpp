// Why the image started, as it tells the ground first.
#pragma once

namespace fw {

const char* boot_text();

}  // namespace fw
