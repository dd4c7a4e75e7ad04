// What the code of a callback asks of the other ranks.
//
// In a callback a rank has its share of the state. What looks at more asks all others for theirs: make_whole, what rank 0
// saves, the surface of a picture. All must ask for the same. If a script went another way on one rank, the two would wait
// for different messages without end. So each rank says first what it asks for, and at last that its callback has ended.
#pragma once

namespace cdem {

enum class Look : char { ended, state, state_on_rank_0, surface };

// All ranks call it together. Throws geom::InputError on a rank that does not ask for what rank 0 asks for: it fails alone, and
// so ends all.
void agree_on_look(Look);

} // namespace cdem
