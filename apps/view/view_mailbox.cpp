#include "view/view_mailbox.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace arris::view {
namespace {

// Of several objects, and of what concerns one client alone, each is an input of its own.
bool is_same_kind(const Input& a, const Input& b) {
  if (a.what.index() != b.what.index()) return false;
  if (const auto* object = std::get_if<SetObject>(&a.what)) {
    return object->id == std::get<SetObject>(b.what).id;
  }
  const bool is_own = std::holds_alternative<Pick>(a.what) ||
                      std::holds_alternative<Hello>(a.what) ||
                      std::holds_alternative<SetSize>(a.what);
  return !is_own || a.client == b.client;
}

template <class T>
void keep(const std::optional<T>& before, std::optional<T>& now) {
  if (!now) now = before;
}

// What the newer one leaves as it is, the older one may have changed.
struct Join {
  const MessageKind& before;

  void operator()(SetRounding& now) const {
    const auto& old = std::get<SetRounding>(before);
    keep(old.method, now.method);
    keep(old.radius, now.radius);
    keep(old.edges, now.edges);
    keep(old.min_angle, now.min_angle);
  }
  void operator()(SetObject& now) const {
    const auto& old = std::get<SetObject>(before);
    keep(old.visible, now.visible);
    keep(old.radius, now.radius);
    keep(old.world_from_object, now.world_from_object);
  }
  void operator()(SetLight& now) const {
    const auto& old = std::get<SetLight>(before);
    keep(old.lighting, now.lighting);
    keep(old.strength, now.strength);
    keep(old.rotation_deg, now.rotation_deg);
  }
  template <class Other>
  void operator()(Other&) const {}
};

}  // namespace

void add_mark(std::vector<InputMark>& marks, const InputMark& mark) {
  const auto known = std::ranges::find(marks, mark.client, &InputMark::client);
  if (known == marks.end()) {
    marks.push_back(mark);
  } else if (mark.seq >= known->seq) {
    *known = mark;
  }
}

void add_marks(std::vector<InputMark>& marks, const std::vector<InputMark>& more) {
  for (const InputMark& mark : more) add_mark(marks, mark);
}

bool ViewMailbox::put(Input input) {
  const auto same = std::ranges::find_if(
      inputs_, [&](const Input& waiting) { return is_same_kind(waiting, input); });
  if (same == inputs_.end()) {
    const auto waiting = std::ranges::count(inputs_, input.client, &Input::client);
    if (std::size_t(waiting) >= kMostInputs) return false;
  } else {
    std::visit(Join{same->what}, input.what);
    std::vector<InputMark> marks = std::move(same->marks);
    add_marks(marks, input.marks);
    input.marks = std::move(marks);
    inputs_.erase(same);
  }
  inputs_.push_back(std::move(input));
  return true;
}

std::vector<Input> ViewMailbox::take() {
  return std::exchange(inputs_, {});
}

}  // namespace arris::view
