// Large things that several benchmarks share: made once, kept while the same one is asked for.
#pragma once

#include <Kokkos_Core.hpp>

#include <memory>
#include <optional>

namespace gridmorph::bench {

/// The last value that was made, until another key is asked for or Kokkos ends: large meshes take gigabytes, and Views
/// may not outlive Kokkos. For function-local statics, made while Kokkos is up.
template <class Key, class Value>
class LastMade {
 public:
  LastMade() {
    Kokkos::push_finalize_hook([this] { drop(); });
  }
  LastMade(LastMade const&) = delete;
  LastMade& operator=(LastMade const&) = delete;

  /// The value of a key, by make() where it is not the one that is kept. The one before is gone when make() starts.
  template <class Make>
  Value const& get(Key const& key, Make const& make) {
    if (key_ != key) {
      drop();
      value_ = std::make_unique<Value const>(make());
      key_ = key;
    }
    return *value_;
  }

 private:
  void drop() {
    value_.reset();
    key_.reset();
  }

  std::optional<Key> key_;
  std::unique_ptr<Value const> value_;
};

}  // namespace gridmorph::bench
