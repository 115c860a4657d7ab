// Messages of the viewer's clients: a message with finite numbers, or one arris::Error.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "arris/error.h"
#include "view/access.h"
#include "view/view_protocol.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace arris::view;  // NOLINT(google-build-using-namespace)
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  find_head(text);
  parse_target(text);
  upload_extension(text);
  is_own_host(text, "127.0.0.1");
  try {
    const ClientMessage message = parse_message(text);
    const auto* camera = std::get_if<SetCamera>(&message.what);
    if (camera != nullptr && !std::isfinite(length(camera->camera.position))) std::abort();
  } catch (const arris::Error&) {
  }
  return 0;
}
