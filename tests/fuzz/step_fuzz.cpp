// What is looked at before Open CASCADE is, which runs in a program of its own: any bytes are taken or give one Error.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "arris/error.h"
#include "io/step_syntax.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  try {
    arris::check_step_syntax(bytes, "part.step");
  } catch (const arris::Error& error) {
    if (error.kind() != arris::Error::Kind::input || error.where().empty()) std::abort();
    return 0;
  }
  arris::find_missing_entity(bytes, "part.step");
  return 0;
}
