// Fields that laws of joints share: residual strength and dilation, stiffness, restitution.
#pragma once

#include "lua/binding/module/record.hpp"
#include "lua/binding/session/session.hpp"

#include "libcdem/joint/joint.hpp"

namespace cdem::script {

std::vector<Field> dilation_fields();          // of both
std::vector<Field> residual_strength_fields(); // of a bond only

// Gives the joint its law where some of them are given; the peak stands in it.
void read_residual_strength(Session&, const Arguments&, Joint&);

const Record<Joint>& joint_stiffness();
const Record<Joint>& joint_impact(); // of contacts that never were bonded

// Such a contact, with what it loses in impacts.
Joint contact_law(const Arguments&);

// "Barton-Bandis, JRC 10, ..."; "" for a joint without a law.
std::string law_text(const Joint&);

} // namespace cdem::script
