#pragma once

#include <initializer_list>

#include "geo/core/field.hpp"
#include "geo/core/stage.hpp"

namespace geo {

/// A stage that also reads what exemplars are chosen and turned by, where it is there.
inline StageInfo guided_by_folds(StageInfo info) {
  for (const FieldSpec* spec : std::initializer_list<const FieldSpec*>{
           &field::orogeny_type, &field::orogeny_age, &field::fold_direction_east,
           &field::fold_direction_north}) {
    info.optional.push_back(spec);
  }
  return info;
}

}  // namespace geo
