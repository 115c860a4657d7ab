// parallel_collect.h — a loop over all cores whose calls each add to a list
// What       parallel_collect<T>(count, chunk, body) calls body(i, list) for each i < count and returns all that the
//            calls have added
// Guarantee  in the order of i, whatever the number of threads; up to `chunk` calls start no thread
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include "base/parallel_for.h"

namespace arris {

template <class T, class Body>
std::vector<T> parallel_collect(std::size_t count, std::size_t chunk, const Body& body) {
  std::vector<T> all;
  if (count <= chunk) {
    for (std::size_t i = 0; i < count; ++i) body(i, all);
    return all;
  }
  std::vector<std::vector<T>> lists((count + chunk - 1) / chunk);
  parallel_for(lists.size(), {}, [&](std::size_t k) {
    for (std::size_t i = k * chunk; i < std::min(count, (k + 1) * chunk); ++i) body(i, lists[k]);
  });
  std::size_t total = 0;
  for (const auto& list : lists) total += list.size();
  all.reserve(total);
  for (auto& list : lists) {
    all.insert(all.end(), std::move_iterator(list.begin()), std::move_iterator(list.end()));
  }
  return all;
}

}  // namespace arris
