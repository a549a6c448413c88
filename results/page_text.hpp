// The text of page.html, put into the program by the build.
#pragma once

namespace whirl::results {

extern const char* const kPageText;

}  // namespace whirl::results
