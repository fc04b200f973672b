// The state of a run as bytes. A class lists its parts once, in
//
//   template <class Archive> void state(Archive& archive) { archive(a_, b_, ...); }
//
// StateWriter writes them, StateReader reads them. Parts are trivially copyable values without pointers,
// strings, vectors and Views of such, and classes with state(). Every part is preceded by its size, so that
// the state of another version of the program is refused.
#pragma once

#include <Kokkos_Core.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace myowave::solver {

// The bytes are not a state of such a run by this version of the program.
struct StateMismatch : std::runtime_error {
  StateMismatch() : std::runtime_error("its state is that of another version of the program") {}
};

template <class T>
concept PlainState = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !Kokkos::is_view_v<T>;

class StateWriter {
 public:
  static constexpr bool loads = false;

  template <class... Parts>
  void operator()(const Parts&... parts) {
    (put(parts), ...);
  }

  // In order. Large Views are not copied: they must not change until the pieces are written.
  std::vector<std::span<const std::byte>> pieces() const {
    std::vector<std::span<const std::byte>> pieces;
    std::size_t from = 0;
    for (const auto& [at, view] : views_) {
      pieces.push_back(std::span(own_).subspan(from, at - from));
      pieces.push_back(view);
      from = at;
    }
    pieces.push_back(std::span(own_).subspan(from));
    return pieces;
  }

 private:
  static constexpr std::size_t large = 1 << 16;  // bytes

  template <class Part>
  void put(const Part& part) {
    if constexpr (PlainState<Part>)
      put_bytes(&part, sizeof part);
    else if constexpr (Kokkos::is_view_v<Part>)
      put_view(part);
    else
      const_cast<Part&>(part).state(*this);  // a writer changes nothing
  }
  void put(const std::string& text) { put_bytes(text.data(), text.size()); }
  template <PlainState T>
  void put(const std::vector<T>& values) {
    put_bytes(values.data(), values.size() * sizeof(T));
  }
  void put(const std::vector<std::string>& texts) {
    put(texts.size());
    for (const auto& text : texts) put(text);
  }

  template <class View>
  void put_view(const View& view) {
    const std::size_t size = view.size() * sizeof(typename View::value_type);
    if constexpr (!Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename View::memory_space>::accessible) {
      const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
      put_bytes(host.data(), size);
    } else if (size < large) {
      put_bytes(view.data(), size);
    } else {
      append(&size, sizeof size);
      views_.push_back({own_.size(), {reinterpret_cast<const std::byte*>(view.data()), size}});
    }
  }

  void put_bytes(const void* data, std::size_t size) {
    append(&size, sizeof size);
    append(data, size);
  }
  void append(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::byte*>(data);
    own_.insert(own_.end(), bytes, bytes + size);
  }

  struct Placed {
    std::size_t at;  // in own_
    std::span<const std::byte> view;
  };
  std::vector<std::byte> own_;
  std::vector<Placed> views_;
};

class StateReader {
 public:
  static constexpr bool loads = true;

  // Refers to the bytes; they must outlive the reader.
  explicit StateReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  // Errors: StateMismatch.
  template <class... Parts>
  void operator()(Parts&... parts) {
    (get(parts), ...);
  }

  bool at_end() const { return bytes_.empty(); }

 private:
  template <class Part>
  void get(Part& part) {
    if constexpr (PlainState<Part>)
      copy(next(), &part, sizeof part);
    else if constexpr (Kokkos::is_view_v<Part>)
      get_view(part);
    else
      part.state(*this);
  }
  void get(std::string& text) {
    const auto part = next();
    text.assign(reinterpret_cast<const char*>(part.data()), part.size());
  }
  template <PlainState T>
  void get(std::vector<T>& values) {
    const auto part = next();
    if (part.size() % sizeof(T) != 0) throw StateMismatch();
    values.resize(part.size() / sizeof(T));
    copy(part, values.data(), part.size());
  }
  void get(std::vector<std::string>& texts) {
    std::size_t count = 0;
    get(count);
    if (count > bytes_.size()) throw StateMismatch();
    texts.resize(count);
    for (auto& text : texts) get(text);
  }

  template <class View>
  void get_view(const View& view) {
    const auto host = Kokkos::create_mirror_view(view);
    copy(next(), host.data(), view.size() * sizeof(typename View::value_type));
    if constexpr (!Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename View::memory_space>::accessible)
      Kokkos::deep_copy(view, host);
  }

  std::span<const std::byte> next() {
    const auto size = take_size();
    if (size > bytes_.size()) throw StateMismatch();
    const auto part = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return part;
  }
  std::size_t take_size() {
    std::size_t size = 0;
    if (bytes_.size() < sizeof size) throw StateMismatch();
    std::memcpy(&size, bytes_.data(), sizeof size);
    bytes_ = bytes_.subspan(sizeof size);
    return size;
  }
  static void copy(std::span<const std::byte> from, void* to, std::size_t size) {
    if (from.size() != size) throw StateMismatch();
    if (size > 0) std::memcpy(to, from.data(), size);
  }

  std::span<const std::byte> bytes_;
};

}  // namespace myowave::solver
