// SPDX-License-Identifier: BSD-3-Clause
//
// Reference to a callable object, for parameters of functions that are compiled once for all callables.
#pragma once

#include <type_traits>
#include <utility>

namespace tegl::detail {

template <class Signature>
class FunctionRef;

/// A callable object by reference. The object must outlive it, which holds for a lambda in the argument list of a call.
/// A call costs one indirect jump, so use it for work on many items at once.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class Call>
  requires(!std::is_same_v<Call, FunctionRef>) FunctionRef(const Call& call)
  noexcept  // NOLINT(google-explicit-constructor): lambdas convert in argument lists
      : object_(&call), call_([](const void* object, Arguments... arguments) -> Result {
          return (*static_cast<const Call*>(object))(std::forward<Arguments>(arguments)...);
        }) {}

  Result operator()(Arguments... arguments) const { return call_(object_, std::forward<Arguments>(arguments)...); }

 private:
  const void* object_;
  Result (*call_)(const void*, Arguments...);
};

}  // namespace tegl::detail
