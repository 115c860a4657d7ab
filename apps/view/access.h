// access.h — who may talk to the viewer's server
// What       the token in the address, the Host and Origin that requests must have, and addresses cut into parts
// Guarantee  no function looks at files; a page of another site, also one whose name was made to lead here, has neither
//            token, Host nor Origin
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace arris::view {

// 128 random bits of the system as 32 hexadecimal digits.
std::string make_token();

// Long enough not to be guessed, of letters, digits, - and _, which addresses take as they are.
bool is_good_token(std::string_view token);

// In a time that does not depend on where the two differ.
bool is_same_secret(std::string_view a, std::string_view b);

// A request's address: its path and the query's values, percent-decoded.
struct Target {
  std::string path;
  std::string token;  // of t=
  std::string name;   // of name=
};
// Nothing for what is no path or too long.
std::optional<Target> parse_target(std::string_view target);

// Whether a Host header's name leads to this server as its user knows it, with any port, as tunnels have their own:
// loopback's names, the name it listens under, or an address, if it listens to more than this machine.
bool is_own_host(std::string_view host, std::string_view listens_at);

// Of the page that this server has sent: http or https at the request's own Host.
bool is_own_origin(std::string_view origin, std::string_view host);

// The name that a page gives a scene file which it saves, if a shell takes it as one word; else "scene.toml".
std::string saved_scene_name(std::string_view name);

// ".stl" for "my part.STL"; nothing for models that don't stand by themselves and what is no model.
std::optional<std::string> upload_extension(std::string_view name);

}  // namespace arris::view
