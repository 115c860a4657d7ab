// shared_vector.h — a vector whose copies share their elements until one of them is changed
// What       copying a Scene costs nothing per triangle or texel. Reading through a const vector never copies the
//            elements; every access through one that is not const does, if they are shared.
// Limits     references and iterators end where a std::vector's would, and with the first change after a copy
// Cost       a reference count a copy; copies in different threads are independent
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace arris {

template <class T>
class SharedVector {
 public:
  // NOLINTBEGIN(readability-identifier-naming): named as the standard library's algorithms want it.
  using value_type = T;
  using const_iterator = typename std::vector<T>::const_iterator;
  using iterator = typename std::vector<T>::iterator;
  // NOLINTEND(readability-identifier-naming)

  SharedVector() = default;
  SharedVector(std::initializer_list<T> elements)
      : elements_(std::make_shared<std::vector<T>>(elements)) {}
  // A vector is one by itself: callers need not say so.
  SharedVector(std::vector<T> elements)  // NOLINT(google-explicit-constructor)
      : elements_(std::make_shared<std::vector<T>>(std::move(elements))) {}

  [[nodiscard]] const std::vector<T>& read() const {
    static const std::vector<T> kEmpty;
    return elements_ ? *elements_ : kEmpty;
  }
  operator const std::vector<T>&() const { return read(); }  // NOLINT(google-explicit-constructor)

  [[nodiscard]] std::size_t size() const { return read().size(); }
  [[nodiscard]] bool empty() const { return read().empty(); }
  const T& operator[](std::size_t i) const { return read()[i]; }
  [[nodiscard]] const T& at(std::size_t i) const { return read().at(i); }
  [[nodiscard]] const T& front() const { return read().front(); }
  [[nodiscard]] const T& back() const { return read().back(); }
  [[nodiscard]] const_iterator begin() const { return read().begin(); }
  [[nodiscard]] const_iterator end() const { return read().end(); }

  // Nobody else has these elements afterwards.
  std::vector<T>& edit() {
    if (!elements_) {
      elements_ = std::make_shared<std::vector<T>>();
    } else if (elements_.use_count() > 1) {
      elements_ = std::make_shared<std::vector<T>>(*elements_);
    } else {
      // What other owners read before they let go comes before what is written now: counting once more
      // synchronises with them.
      // NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
      const std::shared_ptr<std::vector<T>> again = elements_;
    }
    return *elements_;
  }
  T& operator[](std::size_t i) { return edit()[i]; }
  [[nodiscard]] T& at(std::size_t i) { return edit().at(i); }
  [[nodiscard]] T& front() { return edit().front(); }
  [[nodiscard]] T& back() { return edit().back(); }
  [[nodiscard]] iterator begin() { return edit().begin(); }
  [[nodiscard]] iterator end() { return edit().end(); }
  void push_back(T element) { edit().push_back(std::move(element)); }
  template <class... Arguments>
  T& emplace_back(Arguments&&... arguments) {
    return edit().emplace_back(std::forward<Arguments>(arguments)...);
  }
  void resize(std::size_t size) { edit().resize(size); }
  void clear() { elements_.reset(); }

  friend bool operator==(const SharedVector& a, const SharedVector& b) {
    return a.is_same_as(b) || a.read() == b.read();
  }
  // Both have one and the same elements, or none.
  [[nodiscard]] bool is_same_as(const SharedVector& other) const {
    return elements_ == other.elements_ || (empty() && other.empty());
  }

 private:
  std::shared_ptr<std::vector<T>> elements_;
};

}  // namespace arris
