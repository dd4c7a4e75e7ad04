// What the code of a callback asks of the other ranks.
//
// In a callback a rank has its share of the state. Three calls ask the others for their shares: make_whole, a file that
// rank 0 saves, and the surface of a picture. All ranks must make the same call. If a script went another way on one rank,
// the ranks would wait for different messages without end. So each rank first says what it asks for, and finally that its
// callback has ended.
#pragma once

namespace cdem {

enum class Look : char { ended, state, state_on_rank_0, surface };

// All ranks call it together. Throws geom::InputError on a rank that asks for something else than rank 0. This rank then
// fails alone, which ends the others too.
void agree_on_look(Look);

} // namespace cdem
