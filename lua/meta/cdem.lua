---@meta cdem
-- Generated from the declarations that check a script's arguments; do not edit.
-- luacheck: no max line length

---@class cdem
---@field version string Version of the toolkit.
local cdem = {}

---A place: a side of the model's box ("x-" .. "z+"), "all", a body, a name given by model:select, a
---cdem.select.* value, a function(x, y, z) of undeformed places (m), or a list of these.
---@alias cdem.Place string|cdem.Selection|(fun(x: number, y: number, z: number): boolean)|cdem.Place[]

---An axis-aligned box.
---@class (exact) cdem.Box
---@field min number[] m
---@field max number[] m

---One block of an assembly.
---@class (exact) cdem.Block
---@field centroid number[] m
---@field volume number m3
---@field faces integer number of faces
---@field vertices number[][] m

---What the discs of one set come to.
---@class (exact) cdem.DiscStatistics
---@field set string
---@field count integer discs in all
---@field mean_radius number m
---@field dip number deg: of the mean plane
---@field dip_direction number deg
---@field kappa? number of Fisher, (n - 1) / (n - R); nil for fewer than three discs or parallel ones
---@field p30 number 1/m3: centres in the box over its volume
---@field p32 number 1/m: area in the box over its volume
---@field p21? number 1/m: length of traces in the plane, within the box, over its area
---@field p10? number 1/m: crossings with the line over its length

---About the centroid.
---@class (exact) cdem.Inertia
---@field mass number kg
---@field centroid number[] m
---@field tensor number[][] kg m2: three rows
---@field principal number[] kg m2: ascending
---@field principal_ratio number largest over smallest of them

---How good the tetrahedra of a mesh are.
---@class (exact) cdem.MeshQuality
---@field nodes integer
---@field tets integer
---@field outer_faces integer
---@field volume number m3
---@field min_volume number m3
---@field max_volume number m3
---@field min_radius_ratio number 3 r_inscribed / r_circumscribed: 1 regular, 0 flat
---@field mean_radius_ratio number
---@field min_dihedral number deg: 70.5 in a regular tetrahedron
---@field max_dihedral number deg
---@field min_height number m: corner to opposite face: limits the time step
---@field min_edge number m
---@field mean_edge number m
---@field max_edge number m

---Outer faces of a mesh that were picked.
---@class (exact) cdem.FaceGroup
---@field count integer
---@field area number m2
---@field centroid number[] m
---@field area_vector number[] m2: sum of outward normals times area

---Place and attitude of a unit.
---@class (exact) cdem.Pose
---@field centroid number[] m
---@field rotation number[][] rows of the matrix that turns the unit

---Each bond (spring point) stands in exactly one of intact, broken_tension, broken_shear and contacts.
---@class (exact) cdem.Counts
---@field bodies integer
---@field blocks integer
---@field nodes integer
---@field tets integer
---@field interfaces integer
---@field bonds integer
---@field intact integer
---@field broken_tension integer
---@field broken_shear integer
---@field contacts integer
---@field damaged integer of the intact ones: have begun to soften

---The process zone of a law that softens beside the faces that carry it; medians over the faces.
---@class (exact) cdem.ProcessZone
---@field of string body, regions or pair of bodies
---@field length number m: E' G_I / T^2, E' = E / (1 - nu^2)
---@field face_size number m: edge of an equilateral triangle of the face's area
---@field largest_face_size number m: that leaves three faces in the cohesive zone
---@field faces_in_zone number faces in the cohesive zone, 0.88 of the length

---How far from balance a model is.
---@class (exact) cdem.Unbalance
---@field largest number net force of a free node over the reference, the largest
---@field mean number the mean over all free nodes
---@field force number N: net force where the ratio is largest
---@field block integer its id, there
---@field place number[] m

---All the water in the joints of a model.
---@class (exact) cdem.WaterInJoints
---@field points integer of joints, under pressure
---@field area number m2
---@field largest number Pa: pressure
---@field force number N: sum of pressure times area

---What a relaxation came to.
---@class (exact) cdem.RelaxResult
---@field converged boolean
---@field verdict "stable"|"failing"|"undecided" stable: converged; failing: it runs away; undecided: max_steps came before either
---@field steps integer
---@field residual number
---@field broken_tension integer bonds, in this stage
---@field broken_shear integer bonds, in this stage
---@field wall_time number s
---@field moving? number m: what the fastest node moved in the last 200 steps that were looked at
---@field moving_block? integer its block
---@field moving_place? number[] m: where it was, undeformed
---@field trial? string as given

---What real-time stepping came to.
---@class (exact) cdem.RunResultMass_scaling
---@field added_mass number share of the mass of all that deforms, at the end
---@field body? string the one with the largest share added; nil when nothing was
---@field body_added_mass number that share
---@field kinetic_energy number share: over elastic and spring energy, mean over the stage

---@class (exact) cdem.RunResult
---@field steps integer
---@field time number s: of the model
---@field time_step number s
---@field broken_tension integer bonds, in this stage
---@field broken_shear integer bonds, in this stage
---@field wall_time number s
---@field mass_scaling? cdem.RunResultMass_scaling of a stage with mass_scaling

---A solving call.
---@class (exact) cdem.Stage
---@field number integer over all models
---@field kind string
---@field hash string of its arguments
---@field result any

---One trial of a search for the factor of safety.
---@class (exact) cdem.SafetyTrial
---@field factor number
---@field verdict "stable"|"failing"|"undecided"
---@field steps integer
---@field residual number

---What fails: the blocks that have moved by a fifth of the largest displacement or more.
---@class (exact) cdem.Mechanism
---@field blocks number[] their ids, the largest displacement first
---@field volume number m3: of all of them
---@field largest number m3: volume of the largest
---@field share number of the volume of all blocks
---@field centroid number[] m: of all of them, where they were
---@field min number[] m: lower corner of the box of their centroids
---@field max number[] m
---@field displacement number[] m: mean by volume, from the balance of the model

---What the search for the factor of safety came to.
---@class (exact) cdem.FactorOfSafety
---@field factor number middle of the bracket
---@field lower number largest factor at which the model is stable
---@field upper number smallest one at which it is not
---@field stable cdem.Model at lower, in its new balance
---@field failing cdem.Model at upper, as it was when it was found to run away; its displacement is the mechanism
---@field mechanism? cdem.Mechanism what fails at upper; empty in a check, none where nothing has moved
---@field left_out integer blocks that failed at upper in mechanisms below smallest
---@field trials cdem.SafetyTrial[] in the order they were made

---A unit that has left its place, or a piece of one that broke.
---@class (exact) cdem.Departure
---@field unit integer number of the unit in its body, from 1
---@field time number s
---@field velocity? number m/s: of the flow then; nil without one
---@field displacement number[] m: relative to what it touched
---@field place number[] m: of its centroid
---@field share number of the unit's volume; below 1: a piece of it

---A part of settling.
---@class (exact) cdem.SettlePhase
---@field name string
---@field steps integer
---@field time number s: it took
---@field kinetic_ratio number kinetic energy over its peak, at its end
---@field residual number forces out of balance over the loads, at its end

---What settling came to.
---@class (exact) cdem.SettleResult
---@field converged boolean
---@field kinetic_ratio number kinetic energy over its peak
---@field peak_kinetic number J
---@field steps integer
---@field time number s: it took of the model's
---@field made_rigid integer units, while they fell
---@field phases any a list of cdem.SettlePhase
---@field wall_time number s

---A block that was cut.
---@class (exact) cdem.Cut
---@field block integer id
---@field mode "tension"|"shear"
---@field centroid number[] m
---@field normal number[] of the cut planes
---@field principal_stress number[] Pa: tension positive, the largest first
---@field angle_to_largest_pressure number deg: between the cut planes and the axis of the largest pressure, principal_stress[3]
---@field generation integer 0 for an original block
---@field pieces integer
---@field tie boolean both conjugate planes were equally good

---A face of the crack, as it lay in the undeformed body.
---@class (exact) cdem.CrackFace
---@field interface integer id
---@field pass integer
---@field round integer within the pass
---@field mode "tension"|"shear"
---@field centroid number[] m
---@field normal number[]
---@field area number m2
---@field ratio number traction over strength when it broke

---One pass of a growing crack.
---@class (exact) cdem.GrowPass
---@field pass integer from 1
---@field state "growing"|"arrested"|"through"|"stuck"
---@field cuts cdem.Cut[]
---@field faces cdem.CrackFace[] broken in this pass, in order
---@field rounds integer times the worst faces broke and the model was relaxed again
---@field first_ratio number traction over strength of the worst face before any broke
---@field last_ratio number of the worst face that is left
---@field tip number[] m
---@field path number[][] m: from the crack's mouth to its end; empty while there is no crack
---@field steps integer of relaxation

---What growing a crack came to.
---@class (exact) cdem.GrowResult
---@field state "growing"|"arrested"|"through"|"stuck" arrested: nothing reaches its strength any more; through: the crack parts the body; stuck: no balance was reached
---@field passes cdem.GrowPass[]

---A node of a bolt.
---@class (exact) cdem.BoltState
---@field bolt integer from 1, in the order they were set
---@field node integer from 1, from the collar on
---@field place number[] m: undeformed
---@field tension number N: at a collar with a plate that of the plate
---@field grout number N: on the rock, towards the far end; a plate pushes that way
---@field slip number m: of the bolt past the grout
---@field yielded number strain of the next segment that stays

---Water at a place and time.
---@class (exact) cdem.WaterPoint
---@field velocity number[] m/s
---@field acceleration number[] m/s2: of the particles
---@field pressure number Pa: above that of the air
---@field surface? number m: z of the free surface; nil where it is dry or water is everywhere

---A piece of a model that unbroken bonds hold together.
---@class (exact) cdem.Fragment
---@field volume number m3
---@field centroid number[] m
---@field tets integer
---@field held boolean some node of it is held

---One moment of a search.
---@class (exact) cdem.CriticalFlowSample
---@field time number s
---@field pressure number Pa
---@field velocity number m/s
---@field displacement number m: mean where the flow pushes, along it
---@field broken integer bonds so far

---What the search for the critical flow came to.
---@class (exact) cdem.CriticalFlowResultMass_scaling
---@field added_mass number share of the mass of all that deforms, at the end
---@field body? string the one with the largest share added; nil when nothing was
---@field body_added_mass number that share
---@field kinetic_energy number share: over elastic and spring energy, mean over the stage

---@class (exact) cdem.CriticalFlowResult
---@field reason "fragment"|"compliance"|"limit" a piece came off; the compliance grew; or max_velocity was reached
---@field velocity number m/s
---@field pressure number Pa
---@field time number s
---@field period number s: of the first mode
---@field compliance number m/Pa: of the unbroken solid at rest
---@field fragments cdem.Fragment[] largest first
---@field broken_area number m2
---@field place? number[] m: centroid of the broken area; nil when nothing broke
---@field place_fraction? number[] the same in parts of the model's box, 0 to 1
---@field height_fraction? number along the held side's normal, from that side on
---@field part? "root"|"waist"|"top" third of that height
---@field first_break_velocity? number m/s: when the first bond broke; nil when none did
---@field first_break_pressure? number Pa
---@field first_break_place? number[] m: undeformed
---@field broken_tension integer
---@field broken_shear integer
---@field steps integer
---@field curve cdem.CriticalFlowSample[] every 100 steps
---@field mass_scaling? cdem.CriticalFlowResultMass_scaling of a stage with mass_scaling

---A quantity over time, from a file or of your own; what an amplitude takes.
---@class (exact) cdem.Record
---@field times number[] s, ascending
---@field values number[] as many
---@field outside? "hold"|"zero" default "hold": before the first and after the last time: those values, or 0
---@field peak? number largest magnitude
---@field duration? number s
---@field unit? string
---@field end_velocity? number m/s: of an integrated acceleration
---@field end_displacement? number m
---@field baseline? number[] {a0, a1}: a0 + a1 t has been taken off, m/s2 and m/s3

---Where a field is largest or smallest.
---@class (exact) cdem.Extreme
---@field value number
---@field place number[] m: undeformed
---@field block integer id

---Energy ledger, J: what is stored, what was spent, what was given.
---@class (exact) cdem.Energy
---@field elastic number J: stored in the blocks
---@field springs number J: stored in bonds and contacts
---@field bolts number J: stored in bolts and their grout
---@field kinetic number J: of the real masses, or of a relaxation's fictitious ones
---@field damping number J
---@field radiated number J: left through quiet boundaries and free fields
---@field friction number J
---@field breaking number J: lost by bonds that broke or softened
---@field plastic number J: plastic work of blocks that yield
---@field yielding number J: lost by the steel of bolts that yielded
---@field cutting number J: lost when blocks were cut or removed, or freed nodes joined again
---@field fictitious number J: kinetic energy a relaxation threw away at its end
---@field external number J: work of loads, gravity and moving supports
---@field external_peak number J: largest |external| so far
---@field total number J: sum of all but external
---@field balance_error number |total - external| over the largest energy above
---@field one_way_error number the largest so far of: how far damping, friction, breaking, plastic or yielding, which can only rise, fell; how far kinetic and stored energy were above what was given; over the largest energy above

---Volume that two blocks occupy at once, as they stand now.
---@class (exact) cdem.Overlap
---@field volume number m3: of all pairs of blocks
---@field pairs integer
---@field largest number m3: of one pair
---@field place number[] m: of that pair
---@field blocks? string[] names of that pair; nil where nothing overlaps

---A block of a model.
---@class (exact) cdem.BlockState
---@field id integer
---@field parent integer id of the block it was cut from
---@field generation integer how often it was cut
---@field body string
---@field centroid number[] m: undeformed
---@field volume number m3
---@field displacement number[] m: of the centroid
---@field stress number[] Pa: {xx, yy, zz, xy, yz, xz}

---A bond that broke.
---@class (exact) cdem.Break
---@field stage integer
---@field step integer within the stage
---@field time number s
---@field mode "tension"|"shear"
---@field place number[] m: undeformed
---@field normal number[]
---@field area number m2
---@field normal_traction number Pa: when it broke, tension positive
---@field shear_traction number Pa: when it broke
---@field block_a integer id
---@field block_b integer id

---How much has cracked, and what it took.
---@class (exact) cdem.CrackSum
---@field area number m2: of all cracks: the three below together
---@field tension_area number m2: broken in tension
---@field shear_area number m2: broken in shear
---@field damaged_area number m2: damage times area of what softens and is not broken
---@field projected_area number m2: area as the planes that failed see it: a cohesive crack takes its fracture energy on this one
---@field energy number J: taken by breaking and damage
---@field tension_energy number J
---@field shear_energy number J

---How much has cracked, of the model and of each body.
---@class (exact) cdem.CracksBetween
---@field area number m2: of all cracks: the three below together
---@field tension_area number m2: broken in tension
---@field shear_area number m2: broken in shear
---@field damaged_area number m2: damage times area of what softens and is not broken
---@field projected_area number m2: area as the planes that failed see it: a cohesive crack takes its fracture energy on this one
---@field energy number J: taken by breaking and damage
---@field tension_energy number J
---@field shear_energy number J

---@class (exact) cdem.Cracks
---@field area number m2: of all cracks: the three below together
---@field tension_area number m2: broken in tension
---@field shear_area number m2: broken in shear
---@field damaged_area number m2: damage times area of what softens and is not broken
---@field projected_area number m2: area as the planes that failed see it: a cohesive crack takes its fracture energy on this one
---@field energy number J: taken by breaking and damage
---@field tension_energy number J
---@field shear_energy number J
---@field bodies any a cdem.CrackSum for each body, by its name
---@field between cdem.CracksBetween in joints between two bodies

---The tip of a crack along a path: lists with an entry for each step at which it moved on.
---@class (exact) cdem.CrackTipTip
---@field position number m
---@field place number[] m

---@class (exact) cdem.CrackTip
---@field time number[] s
---@field position number[] m: along the path
---@field speed number[] m/s: least-squares slope over the window; nan where no time passes, as in a relaxation
---@field place number[][] m: of the broken point, undeformed
---@field stage number[]
---@field step number[] within the stage
---@field tip? cdem.CrackTipTip the last of them; nil where nothing broke at the start of the path
---@field fastest number m/s: largest speed; 0 where there is none
---@field rayleigh_speed? number m/s: of the body, which no crack in tension can exceed
---@field reach number m
---@field window number s

---Energy release rate at a crack front.
---@class (exact) cdem.JIntegralDomains
---@field inner number m
---@field outer number m
---@field j number J/m2

---@class (exact) cdem.JIntegral
---@field j number J/m2: mean over the domains
---@field spread number largest less smallest of the domains, over the mean
---@field thickness number m: length of the front
---@field domains cdem.JIntegralDomains[]
---@field k_plane_stress? number Pa m^0.5: sqrt(E j); nil where j < 0
---@field k_plane_strain? number Pa m^0.5: sqrt(E j / (1 - nu^2)); nil where j < 0

---What the joints of one set bear and how they have moved.
---@class (exact) cdem.JointSum
---@field set string its name; "": joints of no set
---@field interfaces integer pairs of faces that springs hold
---@field parted integer pairs that are left to contact; no other value counts them
---@field area number m2
---@field open_area number m2: of faces that are apart
---@field broken_area number m2
---@field normal_traction number Pa: mean over the area, tension positive; effective
---@field shear_traction number Pa: mean of its size
---@field water_pressure number Pa: mean
---@field utilisation number traction over strength, 1 where it slides; mean over the area that is not apart
---@field largest_utilisation number
---@field slip number m: size of the shear displacement since the beginning, mean
---@field largest_slip number m
---@field opening number m: below 0: closed under pressure; mean
---@field largest_opening number m

---The points of joints: lists with an entry for each.
---@class (exact) cdem.JointPoints
---@field set string[]
---@field place number[][] m: undeformed
---@field area number[] m2
---@field mode string[] "bonded", "broken_tension", "broken_shear" or "contact"
---@field normal_traction number[] Pa: tension positive; effective
---@field shear_traction number[] Pa
---@field water_pressure number[] Pa
---@field utilisation number[]
---@field opening number[] m
---@field slip number[] m

---A piece of a model that unbroken bonds hold together, as it is and as it moves.
---@class (exact) cdem.FragmentMotion
---@field volume number m3
---@field centroid number[] m: undeformed
---@field tets integer
---@field held boolean some node of it is held
---@field body? string nil where parts of several bodies hang together
---@field diameter number m: of the sphere with its volume
---@field mass number kg
---@field centre number[] m: of mass, now
---@field velocity number[] m/s: of the centre
---@field momentum number[] N s
---@field angular_momentum number[] N m s: about its own centre
---@field kinetic_energy number J: the three below together
---@field translation_energy number J
---@field rotation_energy number J: of the rigid spin with its angular momentum
---@field rest_energy number J: vibration

---How densely units lie on a slope, away from the edge of the pile by about one unit.
---@class (exact) cdem.PileMeasures
---@field porosity? number between the slope and the mean top of the pile; nil, as the next five, with a warning where the pile is too small to measure or reaches beside its ground
---@field porosity_error? number change when every second column is left out
---@field units_per_area? number 1/m2: volume of solid over area and unit volume
---@field units_per_area_times_dn2? number packing density phi = N Dn^2 / A
---@field thickness? number m: mean height of the top above the slope
---@field area? number m2: of slope that was measured
---@field contacts_per_unit number mean number of other meshed blocks that press on a unit
---@field fewest_contacts integer of any unit
---@field contacts number[] of each unit

---Contacts of meshed bodies.
---@class (exact) cdem.Contacts
---@field acting integer semi-springs and semi-edges now
---@field deepest number m: largest depth so far
---@field deepest_over_tet_height number the same over the height of the lower tet

---What one case of a sweep came to.
---@class (exact) cdem.SweepResult
---@field set any as given
---@field output string its folder, in the output folder
---@field exit_code integer 0 when it succeeded
---@field seconds number s: wall clock; 0 for a run that had ended before its sweep was stopped
---@field figures any values of its report by name; empty when it failed, and in a check

---Made by cdem.plastic or cdem.hoek_brown.
---@class cdem.Plasticity
---@field cohesion number Pa
---@field friction_angle number deg
---@field tensile_strength number Pa: what is beyond the tip of the cone, cohesion / tan(friction_angle), does not act
---@field dilation_angle number deg: at most friction_angle
local Plasticity = {}

---Made by cdem.elastic.
---@class cdem.Material
---@field youngs_modulus number Pa: Young's modulus E
---@field poissons_ratio number Poisson's ratio nu
---@field density number kg/m3
---@field viscosity number N s/m4: damping force per volume and velocity, mu of Han 2010 eq 1; used by real-time stepping
---@field stiffness_damping number s: beta of Rayleigh damping, of meshes in real-time stepping: a vibration of angular frequency w has beta w / 2 of critical damping, motion as a rigid body none
---@field shear_modulus number Pa: G = E / 2(1 + nu)
---@field p_wave_modulus number Pa: lambda + 2 G
local Material = {}

---Made by cdem.mohr_coulomb, cdem.hoek_brown_bond, cdem.coulomb, cdem.barton_bandis, cdem.joint_table or cdem.glued.
---@class cdem.Joint
---@field bonded boolean
---@field glued boolean
---@field cohesion number Pa
---@field friction_angle number deg
---@field tensile_strength number Pa
---@field softening "none"|"linear"|"exponential" how the strength falls once it is reached; none: brittle. It needs both fracture energies, and tensile_strength at most cohesion / tan(friction angle)
---@field fracture_energy_1 number J/m2: G_I, work per crack area that opening to separation takes, elastic part included
---@field fracture_energy_2 number J/m2: G_II, the same for slip, beyond the work of friction
---@field thickness_ratio number equivalent thickness of the joint over the block size (cube root of its volume), which sets the stiffness E/L and G/L
---@field thickness? number m: equivalent thickness itself; wins over the ratio. Contacts of meshes take it too
---@field normal_stiffness? number Pa/m: instead of E/L
---@field shear_stiffness? number Pa/m: instead of G/L
---@field stiffness_damping number s: beta of Rayleigh damping, of joints between blocks that move far in real-time stepping, as long as their faces have not parted; refused where it would do nothing
---@field restitution number coefficient of restitution of the contact of bodies that move far: speed after over speed before an impact, as far as the contact and not waves within the bodies decide it; 1: the contact loses nothing but by friction
local Joint = {}

---Convex blocks, made by the builders; #assembly is the number of blocks.
---@class cdem.Assembly
---@operator len: integer
local Assembly = {}

---Sum over the blocks, m3.
---@return number # m3
function Assembly:volume() end

---Smallest axis-aligned box that holds all blocks.
---@return cdem.Box
function Assembly:box() end

---Names of the joint sets and cuts that made faces of the blocks, in the order of the alphabet.
---@return string[]
function Assembly:joint_sets() end

---One table per block.
---@return cdem.Block[]
function Assembly:blocks() end

---The blocks as one solid with a region for each, in their order. Its mesh shares nodes on the faces between them. As the shape of a body, such a mesh breaks along the faces of the blocks with bonded_faces = "regions", and anywhere with bonded_faces = "all".
---@return cdem.Solid
function Assembly:solid() end

---A free-form solid, made by cdem.solid.* and the armour units; it never changes.
---@class cdem.Solid
---@field height? number m: of an armour unit as it was made
---@field density? number kg/m3
---@operator len: integer
local Solid = {}

---
---@return number # m3
function Solid:volume() end

---Volume of each region, m3.
---@return number[]
function Solid:regions() end

---Axis-aligned box around the solid; where curved faces are cut by others it may be up to 1 % too large.
---@return cdem.Box
function Solid:box() end

---@class (exact) cdem.SolidInertiaOptions
---@field density? number kg/m3, > 0: the solid's own when left out; 1 when it has none

---Mass, centroid and inertia about the centroid.
---@param options? cdem.SolidInertiaOptions
---@return cdem.Inertia
function Solid:inertia(options) end

---@class (exact) cdem.SolidMeshOptionsRefineBox
---@field min number[] m
---@field max number[] m

---@class (exact) cdem.SolidMeshOptionsRefine
---@field at? number[] m: near a point
---@field line? number[][] m: along a line, an edge
---@field box? cdem.SolidMeshOptionsRefineBox in a box
---@field size number m, > 0
---@field radius? number m, >= 0, default 0: how far the size holds

---@class (exact) cdem.SolidMeshOptions
---@field size? number m, > 0: edge length; the solid's mesh_size when left out
---@field refine? cdem.SolidMeshOptionsRefine[] smaller tetrahedra in some places
---@field growth? number in [0.05, 2], default 0.3: m of size per m of distance from a refined place

---Tetrahedra that fill the solid; the same call gives the same mesh.
---@param options? cdem.SolidMeshOptions
---@return cdem.TetMesh
function Solid:mesh(options) end

---@class (exact) cdem.SolidTranslateOptions
---@field shift number[] m

---A moved copy.
---@param options cdem.SolidTranslateOptions
---@return cdem.Solid
function Solid:translate(options) end

---@class (exact) cdem.SolidRotateOptions
---@field axis number[] of any length
---@field angle number deg
---@field centre? number[] m, default {0, 0, 0}

---A copy turned, right-handed, about an axis through `centre`.
---@param options cdem.SolidRotateOptions
---@return cdem.Solid
function Solid:rotate(options) end

---@class (exact) cdem.SolidScaleOptions
---@field factor number > 0
---@field centre? number[] m, default {0, 0, 0}

---A copy of another size.
---@param options cdem.SolidScaleOptions
---@return cdem.Solid
function Solid:scale(options) end

---@class (exact) cdem.SolidSaveOptions
---@field file string ends in .step; in the output folder

---Writes a STEP file.
---@param options cdem.SolidSaveOptions
function Solid:save(options) end

---Triangles, made by cdem.read_surface or cdem.surface; #surface is their number.
---@class cdem.Surface
---@operator len: integer
local Surface = {}

---The area of all triangles, m2.
---@return number # m2
function Surface:area() end

---Whether every edge belongs to two triangles.
---@return boolean
function Surface:closed() end

---Smallest axis-aligned box that holds it.
---@return cdem.Box
function Surface:box() end

---Tetrahedra, made by solid:mesh{} or cdem.read_mesh.
---@class cdem.TetMesh
---@field nodes integer how many
---@field tets integer how many
---@field regions integer how many; they are numbered from 1
---@field parts integer how many sets of tetrahedra share no node; in a model each moves by itself
local TetMesh = {}

---
---@return number # m3
function TetMesh:volume() end

---Smallest axis-aligned box that holds all nodes.
---@return cdem.Box
function TetMesh:box() end

---@class (exact) cdem.TetMeshInertiaOptions
---@field density? number kg/m3, > 0, default 1

---Mass, centroid and inertia about the centroid of the tetrahedra.
---@param options? cdem.TetMeshInertiaOptions
---@return cdem.Inertia
function TetMesh:inertia(options) end

---How good the tetrahedra are.
---@return cdem.MeshQuality
function TetMesh:quality() end

---@class (exact) cdem.TetMeshFacesOptionsPlane
---@field point number[] m
---@field normal number[]

---@class (exact) cdem.TetMeshFacesOptions
---@field side? "x-"|"x+"|"y-"|"y+"|"z-"|"z+" faces in that face of the mesh's box
---@field plane? cdem.TetMeshFacesOptionsPlane faces in a plane
---@field tolerance? number m, >= 0: of plane; 1e-6 of the mesh's size when left out
---@field direction? number[] faces whose outward normal points this way
---@field angle? number deg, in [0, 90], default 10: of direction: how far off a normal may be
---@field name? string

---Picks outer faces. With a name, files and pictures show them as point field on_<name>. In a model that is made of the mesh afterwards they are a place: cdem.select.faces.
---@param options? cdem.TetMeshFacesOptions
---@return cdem.FaceGroup
function TetMesh:faces(options) end

---@class (exact) cdem.TetMeshSaveOptions
---@field file string ends in .vtu; in the output folder

---Writes the mesh for ParaView.
---@param options cdem.TetMeshSaveOptions
function TetMesh:save(options) end

---@class (exact) cdem.TetMeshPictureOptionsCamera
---@field position number[] m
---@field focal_point number[] m
---@field up? number[] default {0, 1, 0}
---@field view_angle? number deg, in (0, 180), default 30: over the height of the picture
---@field perspective? boolean default true

---@class (exact) cdem.TetMeshPictureOptionsFit
---@field min number[] m
---@field max number[] m

---@class (exact) cdem.TetMeshPictureOptionsMarkers
---@field at number[] m: undeformed place
---@field label? string
---@field colour? number[] {red, green, blue}, each 0 .. 1
---@field size? number > 0, default 14: pixels across

---@class (exact) cdem.TetMeshPictureOptionsLines
---@field points number[][] m
---@field label? string
---@field colour? number[] {red, green, blue}, each 0 .. 1
---@field width? number > 0, default 4: pixels
---@field dashed? boolean default false

---@class (exact) cdem.TetMeshPictureOptions
---@field file string ends in .png, .svg or .pdf; in the output folder
---@field colour? string "region", "radius_ratio", "min_dihedral", "volume" of the tetrahedra, "on_<name>" of named faces; plain when left out
---@field view? "front"|"back"|"left"|"right"|"top"|"bottom"|"iso" default "front": front looks along -z at the x-y plane
---@field up? "y"|"z" z: front looks along y with z up; default: y
---@field camera? cdem.TetMeshPictureOptionsCamera instead of view
---@field fit? cdem.TetMeshPictureOptionsFit a box that the view shows, in place of what is drawn: give it to all frames of a film, so that the camera does not move with what falls
---@field size? number[] default {1600, 1200}: {width, height} in pixels; height 0: as high as it needs to be
---@field dpi? number in [10, 2400], default 300: pixels in an inch where it is printed: 1600 pixels are 135 mm wide at 300
---@field range? number[] {lowest, highest} of the colours, SI units
---@field colour_map? "auto"|"blue_white_red"|"cool_warm"|"viridis"|"grey"|"categorical" default "auto": auto: blue_white_red when values change sign, viridis when not. Without a range the colours span all values but a few outliers; the legend tells them
---@field title? string _{...} and ^{...} set sub- and superscripts
---@field colour_bar? boolean default true
---@field legend? boolean default true
---@field axes? boolean default true: small arrows that name the directions
---@field scale_bar? boolean default false: a round length under the body; none in perspective
---@field north? number[] the direction of north, {0, 1, 0}: an arrow N beside those of the axes
---@field markers? cdem.TetMeshPictureOptionsMarkers[]
---@field lines? cdem.TetMeshPictureOptionsLines[]
---@field edges? "creases"|"mesh"|"none" default "creases": lines on the surface
---@field crease? number deg, in [0, 180], default 25: the surface is outlined where it turns by more than this

---Draws the mesh, without a display.
---@param options cdem.TetMeshPictureOptions
function TetMesh:picture(options) end

---Units of one shape, each with its place and attitude: made by cdem.drop, cdem.place, cdem.read_pile and model:pile. The shape of a meshed body with one block for each.
---@class cdem.Pile
---@field count integer how many units
---@field height number m: of a unit: that of its mesh along z
---@field unit_volume number m3: of the unit's mesh
---@field nominal_diameter number m: Dn, side of a cube of that volume
---@operator len: integer
local Pile = {}

---@class (exact) cdem.PileScaledOptions
---@field factor number > 0

---The same pile in another size: all lengths about the origin times the factor.
---@param options cdem.PileScaledOptions
---@return cdem.Pile
function Pile:scaled(options) end

---@class (exact) cdem.PileWithUnitOptions
---@field unit cdem.TetMesh

---The same places and attitudes with another mesh of the unit, such as a finer one; it must stand along the same axes.
---@param options cdem.PileWithUnitOptions
---@return cdem.Pile
function Pile:with_unit(options) end

---@class (exact) cdem.PileWallsOptions
---@field onto cdem.TetMesh the ground, z up
---@field height? number m, > 0: over the ground; that of the highest unit when left out, two units at least
---@field thickness? number m, > 0: a unit's height when left out

---Walls that keep the pile together, such as those of a flume, as the mesh of a rigid body that is held. They stand at both sides and at the foot of the ground; on level ground they stand all round. Their inner faces stand at the ends of the pile's box. Their lower edges keep a small gap from the ground, so that walls and ground can be bodies of one model.
---@param options cdem.PileWallsOptions
---@return cdem.TetMesh
function Pile:walls(options) end

---Place and attitude of each unit.
---@return cdem.Pose[]
function Pile:poses() end

---Smallest axis-aligned box that holds all units where they are.
---@return cdem.Box
function Pile:box() end

---@class (exact) cdem.PileSaveOptions
---@field file string ends in .json; in the output folder

---Writes the pile, for cdem.read_pile in another script.
---@param options cdem.PileSaveOptions
function Pile:save(options) end

---A place, made by cdem.select.*; judged on undeformed places, so it survives cutting.
---@class cdem.Selection
local Selection = {}

---Made by cdem.model.
---@class cdem.Model
---@field time number s: in a check: what the runs before would have come to
---@field residual number out-of-balance force norm over applied force norm
---@field steps integer of all stages so far
---@field stable_time_step number s: of real-time stepping
---@field state_hash string of every state field, bit for bit
---@field memory table What callbacks must remember: only booleans, numbers, strings and tables of them. It is saved with the model, a local variable is not.
local Model = {}

---@class (exact) cdem.ModelSelectOptions
---@field name string
---@field on cdem.Place

---Gives a place a name that `on` understands from now on.
---@param options cdem.ModelSelectOptions
function Model:select(options) end

---How many there are of everything.
---@return cdem.Counts
function Model:counts() end

---Whether faces resolve the process zone E' G_I / T^2 of what softens, by body and pair.
---@return cdem.ProcessZone[]
function Model:process_zones() end

---Smallest axis-aligned box around the undeformed model.
---@return cdem.Box
function Model:box() end

---@class (exact) cdem.ModelFixOptions
---@field on cdem.Place where: a place or a list of places
---@field axes? "x"|"y"|"z"|"xy"|"xz"|"yz"|"xyz" default "xyz": components held
---@field displacement? number[] m: total value to be held. A relaxation moves there in its first steps; a run moves there at a steady velocity and arrives at its end (one that `stop` ends earlier does not)
---@field velocity? number[] m/s: in real-time stepping; zero when left out, and in a relaxation
---@field amplitude? cdem.Record|number[][]|fun(time: number): number factor over time (s): a cdem.record, a list { {time, value}, ... } with straight lines between and its first and last value outside, or a function, called once a step; a relaxation asks once at its start; 1 when left out
---@field since? number s: time of the model at which the amplitude's times begin, 0 when left out; since = model.time lets it begin now, in a later stage

---Holds nodes, or moves them as told. A later call wins over an earlier one where they meet.
---@param options cdem.ModelFixOptions
function Model:fix(options) end

---@class (exact) cdem.ModelReleaseOptions
---@field on cdem.Place where: a place or a list of places
---@field axes? "x"|"y"|"z"|"xy"|"xz"|"yz"|"xyz" default "xyz": components set free

---Undoes fixes.
---@param options cdem.ModelReleaseOptions
function Model:release(options) end

---@class (exact) cdem.ModelTractionOptions
---@field on cdem.Place where: a place or a list of places
---@field stress? number[] Pa: force over area
---@field pressure? number|fun(x: number, y: number, z: number): number Pa: instead: along the inward normal, the same everywhere or at each undeformed place
---@field level? number m: instead: z of a free water surface; weight times the depth below it, none above. Water in joints is model:water's
---@field water_table? cdem.WaterTable instead: a free water surface that is not level
---@field weight? number N/m3, > 0, default 9810: of the water
---@field amplitude? cdem.Record|number[][]|fun(time: number): number factor over time (s): a cdem.record, a list { {time, value}, ... } with straight lines between and its first and last value outside, or a function, called once a step; a relaxation asks once at its start; 1 when left out
---@field since? number s: time of the model at which the amplitude's times begin, 0 when left out; since = model.time lets it begin now, in a later stage

---Force per undeformed area on outer faces: a stress, or a pressure along their inward normals, such as that of a reservoir. It acts on faces that are free as the stage begins and does not follow them. Several tractions on a face add up.
---@param options cdem.ModelTractionOptions
function Model:traction(options) end

---@class (exact) cdem.ModelForceOptions
---@field on cdem.Place where: one place
---@field force number[] N: total
---@field amplitude? cdem.Record|number[][]|fun(time: number): number factor over time (s): a cdem.record, a list { {time, value}, ... } with straight lines between and its first and last value outside, or a function, called once a step; a relaxation asks once at its start; 1 when left out
---@field since? number s: time of the model at which the amplitude's times begin, 0 when left out; since = model.time lets it begin now, in a later stage

---A total force, shared among the nodes of a place. Several forces on a node add up.
---@param options cdem.ModelForceOptions
function Model:force(options) end

---@class (exact) cdem.ModelGravityOptions
---@field vector number[]|fun(time: number): number[] m/s2: acceleration, e.g. {0, 0, -9.81}, or a function of time (s) that gives it
---@field water_density? number kg/m3, >= 0, default 0: buoyancy: takes from the weight, never from the inertia
---@field amplitude? cdem.Record|number[][]|fun(time: number): number factor over time (s): a cdem.record, a list { {time, value}, ... } with straight lines between and its first and last value outside, or a function, called once a step; a relaxation asks once at its start; 1 when left out
---@field since? number s: time of the model at which the amplitude's times begin, 0 when left out; since = model.time lets it begin now, in a later stage

---Weight of all blocks; one at a time, the last call counts.
---@param options cdem.ModelGravityOptions
function Model:gravity(options) end

---@class (exact) cdem.ModelCrackPressureOptions
---@field on? cdem.Place default "all": where: a place or a list of places, by the centroids of faces
---@field pressure? number Pa, >= 0
---@field volume? number m3, >= 0: instead: pumped in, in model:run
---@field bulk_modulus? number Pa, > 0: of the fluid; water has 2.2e9
---@field reservoir? number m3, > 0: what the fluid fills beside the cracks, such as a borehole
---@field amplitude? cdem.Record|number[][]|fun(time: number): number factor over time (s): a cdem.record, a list { {time, value}, ... } with straight lines between and its first and last value outside, or a function, called once a step; a relaxation asks once at its start; 1 when left out
---@field since? number s: time of the model at which the amplitude's times begin, 0 when left out; since = model.time lets it begin now, in a later stage

---Pressure of a gas or a fluid on the faces of cracks in cohesive bodies, from the moment they open. The pressure is given, or it is that of a fluid which fills the cracks and a reservoir: bulk_modulus (pumped volume - volume of the cracks) / reservoir. It is the same in all cracks of the place (docs/theory.md, section 22). Several pressures in a crack add up.
---@param options? cdem.ModelCrackPressureOptions
function Model:crack_pressure(options) end

---Takes away tractions, forces, gravity, flows and pressures in cracks.
function Model:clear_loads() end

---@class (exact) cdem.ModelInitialVelocityOptions
---@field on? cdem.Place default "all": where: a place or a list of places, each by itself
---@field velocity? number[] m/s: v
---@field angular_velocity? number[] rad/s: w, right-handed about its direction; a full turn is 2 pi
---@field about? number[] m: the point that w turns about; the centroid of what is selected when left out

---Gives blocks, meshes and rigid bodies the motion v + w x (x - about) of a rigid body, as velocities before the first real-time step. It replaces the velocities that they had.
---@param options? cdem.ModelInitialVelocityOptions
function Model:initial_velocity(options) end

---@class (exact) cdem.ModelRemoveOptions
---@field on cdem.Place where: a place or a list of places
---@field relaxed? number in [0, 1], default 1: share of the excavation's forces that goes, from the beginning (lambda of convergence-confinement); the rest stays as a load
---@field over? number s, > 0: time of model:run, from now on, in which this share goes evenly; at once when left out. A relaxation takes no time

---Takes blocks and whole meshes out of the model (an excavation): those whose undeformed centroid is selected. Their forces on the rock that stays go at once, unless `relaxed` and `over` say otherwise (docs/settling-and-loading.md, "Excavating").
---@param options cdem.ModelRemoveOptions
---@return integer # how many
function Model:remove(options) end

---@class (exact) cdem.ModelRelaxExcavationOptions
---@field relaxed? number in [0, 1], default 1: share of the excavation's forces that goes, from the beginning (lambda of convergence-confinement); the rest stays as a load
---@field over? number s, > 0: time of model:run, from now on, in which this share goes evenly; at once when left out. A relaxation takes no time

---Lets go of forces that earlier calls of model:remove have kept with `relaxed` or `over`, for instance after a lining is set. Forces that are relaxed further already stay so.
---@param options? cdem.ModelRelaxExcavationOptions
function Model:relax_excavation(options) end

---@class (exact) cdem.ModelMakeRigidOptions
---@field on cdem.Place where: a place or a list of places

---Makes the meshed bodies rigid whose undeformed centroid is selected: they keep the shape and the stress of this moment, and move as a whole.
---@param options cdem.ModelMakeRigidOptions
---@return integer # how many changed
function Model:make_rigid(options) end

---@class (exact) cdem.ModelMakeDeformableOptions
---@field on cdem.Place where: a place or a list of places

---Makes the rigid bodies deformable whose undeformed centroid is selected. They keep the motion that they have.
---@param options cdem.ModelMakeDeformableOptions
---@return integer # how many changed
function Model:make_deformable(options) end

---@class (exact) cdem.ModelBreakBondsOptions
---@field on cdem.Place where: a place or a list of places
---@field whole_faces? boolean default false: only faces that are selected with all their points, so that faces that meet the notch at its tip stay bonded

---Breaks bonds before anything is loaded (a notch): those whose point is selected.
---@param options cdem.ModelBreakBondsOptions
---@return integer # how many
function Model:break_bonds(options) end

---@class (exact) cdem.ModelUnbondOptions
---@field on cdem.Place where: a place or a list of places
---@field whole_faces? boolean default false: only faces that are selected with all their points, so that faces that meet the notch at its tip stay bonded

---The old name of model:break_bonds; it warns.
---@param options cdem.ModelUnbondOptions
---@return integer # how many
function Model:unbond(options) end

---@class (exact) cdem.ModelInitialStressOptions
---@field on? cdem.Place default "all": where: one place
---@field stress? number[] Pa: {xx, yy, zz, xy, yz, xz}, tension positive
---@field gradient? number Pa/m, >= 0: weight per volume, density times 9.81
---@field k0? any horizontal over vertical stress, one number or {kx, ky}; needed with gradient
---@field surface? number m: z where depth begins, the top of the model when left out; above it there is none

---Stress present before anything moves: the same everywhere, growing with depth, or the sum of both. The vertical stress at depth d below the surface is -gradient d, the horizontal one k0 times that. Interfaces between two blocks that are both selected start with its traction.
---@param options? cdem.ModelInitialStressOptions
---@return integer # joint points that this loads beyond their strength; a warning tells of them
function Model:initial_stress(options) end

---@class (exact) cdem.ModelGravityStressOptions
---@field residual? number in (0, 1), default 1e-06: goal: out-of-balance force norm over applied force norm
---@field max_steps? integer >= 1, default 500000: gives up with converged = false

---Stress of the model's own weight: relaxes under gravity and what else acts, without breaking bonds, and then sets the displacement to zero.
---@param options? cdem.ModelGravityStressOptions
---@return cdem.RelaxResult
function Model:gravity_stress(options) end

---Results show the displacement from here on: fields, measures, files and pictures, which draw the model where it stands now. Stress, joints and supports go on as before; opening and slip of joints, and the displacement of fix{}, still count from the beginning.
function Model:reset_displacement() end

---@class (exact) cdem.ModelUnbalanceOptions
---@field reference? number N, > 0: force to compare with instead of the weights

---How far from balance the model is now: the net forces of its free nodes over the weight of their blocks. The ratio is 0 in balance, and 1 where a node feels a force like the weight of its whole block.
---@param options? cdem.ModelUnbalanceOptions
---@return cdem.Unbalance
function Model:unbalance(options) end

---@class (exact) cdem.ModelWaterOptions
---@field level? number m: z of a level water table: weight times the depth below it
---@field water_table? cdem.WaterTable instead: one that is not level; weight times the vertical depth below it
---@field pressure? number|fun(x: number, y: number, z: number): number Pa, >= 0: instead: the same everywhere, or at each place; 0 takes the water away
---@field table? [number, number][] instead: rows {z (m), pressure (Pa)}, upwards; straight between them, constant beyond
---@field joints? string[] names of joint sets and cuts that hold it; all joints when left out, glued cuts never
---@field on? cdem.Place default "all": where: one place; joints elsewhere keep what they have
---@field weight? number N/m3, > 0, default 9810: of the water

---Water in the joints between blocks. Its pressure pushes the two faces of a joint apart, open or closed, and the joint's law bears the rest, the effective stress. It is taken at the undeformed places, once, and stays until it is set again; call it between stages to raise or lower the water.
---@param options? cdem.ModelWaterOptions
---@return cdem.WaterInJoints
function Model:water(options) end

---@class (exact) cdem.ModelRelaxOptions
---@field residual? number in (0, 1), default 1e-06: goal: out-of-balance force norm over applied force norm
---@field breaking? boolean default true: bonds may break
---@field max_steps? integer >= 1, default 500000: gives up with converged = false, undecided
---@field stop_on_failure? boolean default true: ends where the model runs away, with the verdict "failing"; false: goes on, for a fall that something may catch
---@field trial? string name of a trial, "F = 1.2", for progress, log and report; that it fails is then an answer and no warning
---@field every? integer >= 1: steps between calls, 100 by default; without a callback steps between samples of the history from here on, 10 at first
---@field callback? fun() called every so many steps; may read the model and write files

---Dynamic relaxation to static balance, with fictitious masses and adaptive damping (Han 2010 eq 12). The verdict tells a model that stands from one that runs away (docs/theory.md, section 25).
---@param options? cdem.ModelRelaxOptions
---@return cdem.RelaxResult
function Model:relax(options) end

---@class (exact) cdem.ModelRunOptionsMass_scaling
---@field step? number s, > 0: the time step
---@field factor? number instead: over the step that the true masses allow, at least 1

---@class (exact) cdem.ModelRunOptions
---@field duration? number s, > 0
---@field steps? integer >= 1: instead of duration
---@field safety? number in (0, 1], default 0.9: time step over the stable one, at most 1; rigid bodies that touch take 0.5 at most
---@field time_step? number s, > 0: instead of safety; at most the stable one, half of it for rigid bodies that may touch
---@field mass_scaling? cdem.ModelRunOptionsMass_scaling for quasi-static stages: nodes that need a shorter time step get more inertia, not more weight; instead of time_step
---@field breaking? boolean default true: bonds may break
---@field local_damping? number in [0, 1), default 0: force against the motion as a fraction of the out-of-balance force (Cundall)
---@field every? integer >= 1: steps between calls, 100 by default; without a callback steps between samples of the history from here on, 10 at first
---@field callback? fun() called every so many steps; may read the model and write files
---@field stop? fun(): boolean ends the stage when it returns true

---Explicit stepping in real time with the real masses.
---@param options? cdem.ModelRunOptions
---@return cdem.RunResult
function Model:run(options) end

---Has a function called after every solving call from now on, for what each stage should leave behind.
---@param callback fun(stage: cdem.Stage) may read the model and write files
function Model:after_stage(callback) end

---The model's solving calls so far.
---@return cdem.Stage[]
function Model:stages() end

---Another model in the same state, with the same conditions and without histories and probes; what becomes of one does not touch the other.
---@return cdem.Model
function Model:copy() end

---@class (exact) cdem.ModelReduceStrengthOptions
---@field factor number > 0
---@field reduce ("joints"|"blocks")[] strengths that are divided: joints (cohesion, tan(phi) and tensile strength of joints, bonds and contacts), blocks (those of plasticity)

---Divides strengths by a factor: cohesion, tan(phi) and tensile strength. Stiffness, fracture energies and the state stay; glued faces never break. A second call acts on top of the first.
---@param options cdem.ModelReduceStrengthOptions
function Model:reduce_strength(options) end

---@class (exact) cdem.ModelWatchOptions
---@field body string name of a body of meshes
---@field leaves number m, > 0: half a unit's height is usual

---Watches the units of a body from now on. A unit has left when its centroid has moved by `leaves` in two measures: relative to the ground, and relative to its neighbours. The neighbours are the units and the ground that it touched when the watch began; their mean motion counts, without that of units that have left.
---@param options cdem.ModelWatchOptions
---@return cdem.Watch # #watch, watch[i]: the units that have left so far, in order
function Model:watch(options) end

---@class (exact) cdem.ModelSettleOptions
---@field kinetic_energy_ratio? number in (0, 1), default 1e-06: goal: kinetic energy over the largest there was
---@field rigid? boolean default true: free units fall as rigid bodies
---@field local_damping? number in [0, 1), default 0.5: of what touches: force against the motion as a fraction of the out-of-balance force (Cundall)
---@field friction_angle? number deg, in [0, 90): contacts have no more of it while units settle, so that they slide until they lean on more; each its own when left out, and afterwards
---@field max_time? number s, > 0, default 60: of the model, then a warning
---@field safety? number in [0, 1], default 0.5: time step over the stable one; with more, contacts that open and close keep shaking
---@field time_step? number s, > 0: of the rigid fall, at most the stable one, which it is by default
---@field every? integer >= 1: steps between calls, 100 by default; in whole twenties
---@field callback? fun() called every so many steps; may read the model and write files

---Lets units fall and come to rest: free ones as rigid bodies first, then deformable, until they are slow and carry their weight. Rigid units, damping and a lower friction are off afterwards.
---@param options? cdem.ModelSettleOptions
---@return cdem.SettleResult
function Model:settle(options) end

---@class (exact) cdem.ModelRefineOptions
---@field tension_threshold? number Pa, >= 0, default 0: a block is cut when its stress is this close to the tensile strength
---@field shear_threshold? number Pa, >= 0, default 0: the same for the Mohr-Coulomb line
---@field planes? integer in [1, 15], default 3: equally spaced parallel cuts
---@field max_depth? integer in [1, 6], default 1: a block that was cut this often is left alone
---@field criterion? "mohr_coulomb"|"griffith" default "mohr_coulomb"
---@field region? cdem.Place only blocks whose centroid lies in this one place
---@field cohesion? number Pa, >= 0: for the criterion, instead of the joint's
---@field friction_angle? number deg, in [0, 90): for the criterion, instead of the joint's
---@field tensile_strength? number Pa, >= 0: for the criterion, instead of the joint's
---@field may_break? "all"|"cut_faces"|"near_cuts" default "near_cuts": interfaces that may break from now on: all, the cut planes, or these and the original faces between two cut blocks

---Cuts blocks near failure along their failure plane into slices (Han 2010 eqs 13-20); the pieces are bonded and carry the state over.
---@param options? cdem.ModelRefineOptions
---@return cdem.Cut[] # one table per block that was cut
function Model:refine(options) end

---@class (exact) cdem.ModelGrowOptions
---@field passes? integer >= 1, default 3: at most this many
---@field break_ratio? number in (0, 1], default 0.9: faces that carry this part of the worst ratio of traction to strength break together
---@field breaking? "front"|"anywhere" default "front": faces that may break: those that meet the crack's front, or any; any while there is no crack
---@field anchor_at_tip? boolean default true: blocks that the crack enters are cut, and one plane passes through its tip
---@field judged_by? "tip"|"block" default "tip": what turns the planes: the stress around the tip, or each block's own mean (Han 2010)
---@field tip_radius? number m, > 0: reach of the stress around the tip and, without anchor_at_tip, of the cutting; one block size when left out
---@field residual? number in (0, 1), default 1e-05: goal of every relaxation
---@field max_steps? integer >= 1, default 500000: of every relaxation
---@field max_rounds? integer >= 1, default 200: of breaking, in each pass
---@field callback? fun(pass: cdem.GrowPass) called after every pass, with the model in balance; may read the model and write files
---@field tension_threshold? number Pa, >= 0, default 0: a block is cut when its stress is this close to the tensile strength
---@field shear_threshold? number Pa, >= 0, default 0: the same for the Mohr-Coulomb line
---@field planes? integer in [1, 15], default 3: equally spaced parallel cuts
---@field max_depth? integer in [1, 6], default 1: a block that was cut this often is left alone
---@field criterion? "mohr_coulomb"|"griffith" default "mohr_coulomb"
---@field region? cdem.Place only blocks whose centroid lies in this one place
---@field cohesion? number Pa, >= 0: for the criterion, instead of the joint's
---@field friction_angle? number deg, in [0, 90): for the criterion, instead of the joint's
---@field tensile_strength? number Pa, >= 0: for the criterion, instead of the joint's
---@field may_break? "all"|"cut_faces"|"near_cuts" interfaces that may break from now on: all, the cut planes, or these and the original faces between two cut blocks; the cut planes when left out, near_cuts without anchor_at_tip

---Lets a crack advance in passes: blocks at its tip are cut along their failure plane, the worst faces break, the model finds its balance, until nothing breaks; then the next pass (Han 2010 example 4.2).
---@param options? cdem.ModelGrowOptions
---@return cdem.GrowResult
function Model:grow(options) end

---@class (exact) cdem.ModelBoltsOptionsPattern
---@field centre number[] m: a point of the axis they fan out from
---@field axis? "x"|"y"|"z" default "y"
---@field radius number m, > 0: from the axis to the collars
---@field length number m, > 0
---@field angles number[] degrees from the horizontal (x; y where the axis is x), 90 is up (z)
---@field at number[] places along the axis, m

---@class (exact) cdem.ModelBoltsOptions
---@field from? number[] m: of one bolt: the collar
---@field to? number[] m: its far end
---@field pattern? cdem.ModelBoltsOptionsPattern fans of bolts, instead of from and to
---@field area number m2, > 0: of the steel
---@field youngs_modulus? number Pa, > 0, default 2e+11: of the steel
---@field yield_stress? number Pa, > 0: of the steel; it does not yield when left out
---@field grout_stiffness? number N/m2, > 0, default 1e+09: force per length of bolt and displacement past the rock
---@field grout_strength? number N/m, > 0: force per length; it does not slip when left out
---@field pretension? number N, >= 0, default 0: of the plate once the bolt is tight
---@field plate? boolean default false: the collar is fast to the rock
---@field free_length? number m, >= 0, default 0: without grout, from the collar on
---@field segments? integer in [1, 1000], default 10

---Sets grouted bolts or cables into the rock as it stands now: steel that yields, grout that slips, along the axis only. Both ends of each must lie in the rock.
---@param options cdem.ModelBoltsOptions
---@return integer # how many
function Model:bolts(options) end

---Forces along the bolts, one table per node.
---@return cdem.BoltState[]
function Model:bolt_forces() end

---@class (exact) cdem.ModelSaveBoltsOptions
---@field file? string default "bolts.csv": in the output folder

---Writes them as .csv: bolt, node, x, y, z, tension, grout, slip, yielded.
---@param options? cdem.ModelSaveBoltsOptions
function Model:save_bolts(options) end

---@class (exact) cdem.ModelFlowOptions
---@field direction? number[] of the flow; made a unit vector
---@field velocity? number|fun(time: number): number m/s, >= 0
---@field on? cdem.Place default "all": outer faces that may take it: one place; of water: a place or a list of places
---@field water_density? number kg/m3, > 0, default 1025: sea water by default
---@field new_faces? boolean default false: faces opened by cracks take the pressure too; always with water
---@field water? cdem.Water a field of water in place of direction, velocity and density: drag, pressure and with it buoyancy on the wet part of each face, and added mass, as far as the field knows them
---@field drag? number in [0, 100], default 1: C_D; scales the traction, which by itself gives a convex body C_D = 1 of its silhouette
---@field added_mass? number in [0, 100], default 0: C_A = C_M - 1, of the volume under water: sphere 0.5, cylinder across the stream 1, cube 0.67
---@field relative? boolean default true: in a run the water meets each point of the surface at its velocity less that of the surface, u, and the traction is rho/2 (u . n)+ u: a unit that the flow carries gains on it no more, and one that moves in still water is slowed down. false: the pressure of the flow alone, however the surface moves

---Pressure of a flow on the outer faces that look towards it, as they stand at each moment: alpha F along the flow, alpha the cosine to the inward normal (Feng 2014 eqs 19-20), on a surface at rest. With water = a field, the forces of waves. Shielding is not modelled.
---@param options? cdem.ModelFlowOptions
function Model:flow(options) end

---@class (exact) cdem.ModelCriticalFlowOptionsMass_scaling
---@field step? number s, > 0: the time step
---@field factor? number instead: over the step that the true masses allow, at least 1

---@class (exact) cdem.ModelCriticalFlowOptions
---@field direction number[] of the flow; made a unit vector
---@field on? cdem.Place default "all": outer faces that may take it: one place
---@field water_density? number kg/m3, > 0, default 1025: sea water by default
---@field new_faces? boolean default false: faces opened by cracks take the pressure too
---@field mode? "hold"|"ramp" default "hold": hold: the pressure rises only while no bond broke for hold_periods, near the static strength; ramp: always, and inertia has its part
---@field held? "x-"|"x+"|"y-"|"y+"|"z-"|"z+" the side that is fixed: then the result says at which part of the height the solid broke
---@field pressure_rate? number Pa/s, > 0, default 5e+06
---@field hold_periods? number > 0, default 3: hold time in periods of the first mode
---@field fragment_fraction? number in (0, 1), default 0.1: of the volume: what counts as broken off
---@field compliance_ratio? number > 1, default 10: to the unbroken, static one: what counts as broken
---@field max_velocity? number m/s, > 1, default 100: gives up there
---@field safety? number in [0, 1], default 0.9: time step over the stable one
---@field mass_scaling? cdem.ModelCriticalFlowOptionsMass_scaling for quasi-static stages: nodes that need a shorter time step get more inertia, not more weight; instead of time_step
---@field local_damping? number in [0, 1), default 0.1: above 0.2 it acts as added mass

---Raises a flow from 1 m/s until a held solid breaks: a piece of it comes off, or it has become compliant. The pressure is that on a surface at rest.
---@param options cdem.ModelCriticalFlowOptions
---@return cdem.CriticalFlowResult
function Model:critical_flow(options) end

---@class (exact) cdem.ModelQuietOptions
---@field on cdem.Place where: a place or a list of places
---@field velocity? number[] m/s: of the particles in the entering wave alone
---@field stress? number[] Pa: traction of the entering wave alone on these faces; the boundary adds 2 of it
---@field amplitude? cdem.Record|number[][]|fun(time: number): number factor over time (s): a cdem.record, a list { {time, value}, ... } with straight lines between and its first and last value outside, or a function, called once a step; a relaxation asks once at its start; 1 when left out
---@field since? number s: time of the model at which the amplitude's times begin, 0 when left out; since = model.time lets it begin now, in a later stage

---Quiet boundary (Lysmer and Kuhlemeyer 1969): dashpots on outer faces let waves out, and a wave may enter through them. It takes the place of a fix of the same place, whose reactions stay as loads. For real-time stepping.
---@param options cdem.ModelQuietOptions
function Model:quiet(options) end

---@class (exact) cdem.ModelFreeFieldOptions
---@field on cdem.Place "x-", "x+", "y-", "y+", or a list of them

---Vertical sides that move as if the rock went on beyond them: a column in one dimension, with the foot of the model (quiet or fix on z-, given before), moves each side through dashpots. It takes the place of a fix of the same side, whose reactions stay as loads.
---@param options cdem.ModelFreeFieldOptions
function Model:free_field(options) end

---Largest value of a field.
---@param field string e.g. "displacement.x", "stress.yy"; model:fields() has all
---@param on? cdem.Place where: one place; the whole model when left out. Stresses are those of blocks: on a side, of those that have a face there; elsewhere of those whose centroid is there
---@return number
function Model:max(field, on) end

---Smallest value of a field.
---@param field string e.g. "displacement.x", "stress.yy"; model:fields() has all
---@param on? cdem.Place where: one place; the whole model when left out. Stresses are those of blocks: on a side, of those that have a face there; elsewhere of those whose centroid is there
---@return number
function Model:min(field, on) end

---Largest value of a field, and where it is.
---@param field string e.g. "displacement.x", "stress.yy"; model:fields() has all
---@param on? cdem.Place where: one place; the whole model when left out. Stresses are those of blocks: on a side, of those that have a face there; elsewhere of those whose centroid is there
---@return cdem.Extreme
function Model:find_max(field, on) end

---Smallest value of a field, and where it is.
---@param field string e.g. "displacement.x", "stress.yy"; model:fields() has all
---@param on? cdem.Place where: one place; the whole model when left out. Stresses are those of blocks: on a side, of those that have a face there; elsewhere of those whose centroid is there
---@return cdem.Extreme
function Model:find_min(field, on) end

---Mean of a field: over nodes, or over blocks by volume.
---@param field string e.g. "displacement.x", "stress.yy"; model:fields() has all
---@param on? cdem.Place where: one place; the whole model when left out. Stresses are those of blocks: on a side, of those that have a face there; elsewhere of those whose centroid is there
---@return number
function Model:mean(field, on) end

---Value of a field at an undeformed place, interpolated in the block there.
---@param field string e.g. "displacement.x", "stress.yy"; model:fields() has all
---@param place number[] m
---@return number
function Model:at(field, place) end

---Force that holds a place from outside: the force of its supports. A quiet boundary or a free field gives the force of the support that it replaced, of its dashpots, and of the waves that enter. The reaction balances everything that acts on the held nodes. A rigid body is held as a whole, so its reaction includes its weight; a held side includes the weight of the nodes on it. A node on an edge counts in both sides.
---@param on cdem.Place where: one place
---@return number[] # N, {x, y, z}
function Model:reaction(on) end

---Names that max, min, mean, at and probe understand.
---@return string[]
function Model:fields() end

---Energy ledger.
---@return cdem.Energy
function Model:energy() end

---How far contacts let blocks into each other, as a volume.
---@return cdem.Overlap
function Model:overlap() end

---One table per block.
---@return cdem.BlockState[]
function Model:blocks() end

---One table per broken bond, the oldest first.
---@return cdem.Break[]
function Model:breaks() end

---Histories as lists by name: stage, step, time, residual, kinetic_energy, external_work, broken_tension, broken_shear and the probes. The first sample of a run is its beginning. The same are in history.csv after each stage.
---@return table<string, number[]>
function Model:history() end

---@class (exact) cdem.ModelProbeOptions
---@field name string of the column
---@field field string e.g. "displacement.x", "stress.yy"; model:fields() has all
---@field at number[] m: undeformed place

---Samples a field at a place into the history.
---@param options cdem.ModelProbeOptions
function Model:probe(options) end

---@class (exact) cdem.ModelRecordReactionOptions
---@field name string
---@field on string "x-" .. "z+", or a body by name

---Samples the force of the supports and boundaries (model:reaction) on a side or a body into the history (N), as columns <name>_x, <name>_y and <name>_z. Each sample costs some steps.
---@param options cdem.ModelRecordReactionOptions
function Model:record_reaction(options) end

---@class (exact) cdem.ModelRecordMomentumOptions
---@field name string
---@field body string by name

---Samples the momentum of a body into the history (N s), as columns <name>_x, <name>_y and <name>_z.
---@param options cdem.ModelRecordMomentumOptions
function Model:record_momentum(options) end

---Area of all cracks and the energy they took, of the model and of each body.
---@return cdem.Cracks
function Model:cracks() end

---@class (exact) cdem.ModelRecordCracksOptions
---@field name? string default "crack"
---@field body? string by name; the whole model when left out

---Samples the area and energy of cracks into the history, as columns <name>_area, <name>_tension_area, <name>_shear_area, <name>_damaged_area, <name>_projected_area, <name>_energy, <name>_tension_energy and <name>_shear_energy (as in cdem.CrackSum).
---@param options? cdem.ModelRecordCracksOptions
function Model:record_cracks(options) end

---@class (exact) cdem.ModelCrackTipOptions
---@field point? number[] m: where the crack starts, undeformed; the path runs on to the end of the model
---@field direction? number[] of that straight path
---@field path? number[][] m: instead of point and direction: its corners, undeformed, the first where the crack starts. Along a face of a body it follows what shows there
---@field width number m, > 0: how far from the path a broken point may lie
---@field reach? number m, > 0: points nearer than this hang together; about the edge of a tetrahedron when left out
---@field window? number s, > 0: over which the speed is fitted; several times what the crack takes for one element. A tenth of the time it ran when left out
---@field body? string whose Rayleigh speed is told; the only one when left out

---Where the tip of a crack was along a path, and how fast it ran, from the bonds that broke. The tip is the farthest broken point that hangs together with the start of the path; a microcrack ahead counts once the crack has met it.
---@param options cdem.ModelCrackTipOptions
---@return cdem.CrackTip
function Model:crack_tip(options) end

---@class (exact) cdem.ModelJIntegralOptions
---@field point number[] m: anywhere on the front, undeformed
---@field front number[] direction of the front, through the thickness
---@field growth number[] where the crack would go on, square to the front
---@field radii number[] m: outer radii of the domains, about the front; several show whether they agree
---@field inner? number in [0, 1), default 0.5: inner radius over the outer one; a blunt notch must lie within it
---@field body? string with the crack; the only one when left out

---Energy release rate at a straight crack front or notch of a meshed body, the mean over its thickness (J integral over domains of tetrahedra). The body must be at rest at small strain, the crack faces free, flat and parallel to the growth, without supports, loads, contacts and bonds in the domain; anything else is refused.
---@param options cdem.ModelJIntegralOptions
---@return cdem.JIntegral
function Model:j_integral(options) end

---@class (exact) cdem.ModelJointsOptions
---@field sets? string[] names of joint sets and cuts; all joints when left out
---@field on? cdem.Place default "all": where: one place

---What joints between blocks bear and how they have moved: a row for each joint set and named cut, and one, at the end, for joints of no set.
---@param options? cdem.ModelJointsOptions
---@return cdem.JointSum[]
function Model:joints(options) end

---@class (exact) cdem.ModelJointPointsOptions
---@field sets? string[] names of joint sets and cuts; all joints when left out
---@field on? cdem.Place default "all": where: one place

---The same point by point, of joints that springs still hold.
---@param options? cdem.ModelJointPointsOptions
---@return cdem.JointPoints
function Model:joint_points(options) end

---Pieces that unbroken bonds hold together, with their size and motion.
---@return cdem.FragmentMotion[] # largest first
function Model:fragments() end

---@class (exact) cdem.ModelSaveFragmentsOptions
---@field file string ends in .csv; in the output folder

---Writes a row for each fragment, the largest first: number of its body from 1 (0: parts of several), tets, held, volume, diameter, mass, centre, momentum, angular momentum, energies.
---@param options cdem.ModelSaveFragmentsOptions
function Model:save_fragments(options) end

---@class (exact) cdem.ModelPileOptions
---@field body string name of a meshed body

---The units of a body as they lie now, without their deformation: a pile that can be scaled, saved and be the shape of a body of another model.
---@param options cdem.ModelPileOptions
---@return cdem.Pile
function Model:pile(options) end

---@class (exact) cdem.ModelPileMeasuresOptions
---@field body string name of a meshed body
---@field onto string name of the body they lie on

---Porosity, density and thickness of a layer of units, and how many neighbours press on them.
---@param options cdem.ModelPileMeasuresOptions
---@return cdem.PileMeasures
function Model:pile_measures(options) end

---How many contacts of meshed bodies act, and how deep they have been.
---@return cdem.Contacts
function Model:contacts() end

---@class (exact) cdem.ModelLowestUnitsOptions
---@field body string
---@field count integer >= 1
---@field up? number[] default {0, 0, 1}

---Numbers of the units whose centroids are lowest now, for cdem.select.units.
---@param options cdem.ModelLowestUnitsOptions
---@return integer[] # the lowest first
function Model:lowest_units(options) end

---@class (exact) cdem.ModelHighestUnitsOptions
---@field body string
---@field count integer >= 1
---@field up? number[] default {0, 0, 1}

---Numbers of the units whose centroids are highest now, for cdem.select.units.
---@param options cdem.ModelHighestUnitsOptions
---@return integer[] # the highest first
function Model:highest_units(options) end

---@class (exact) cdem.ModelSaveOptions
---@field file string ends in .vtu, or .vtkhdf for programs that read HDF5; in the output folder
---@field series? string ends in .pvd: a time series this file is added to; run.pvd has run_bonds.pvd, run_contacts.pvd and run_water.pvd beside it. One axis: time where it rises from file to file, else steps
---@field cells_per_file? integer >= 1, default 2000000: a .vtu of more cells is written in pieces, result/result_0.vtu, result/result_1.vtu, ..., and result.pvtu takes its place

---Writes the model for ParaView: the blocks to the file, the bonds beside it (result.vtu, result_bonds.vtu). Bodies that move far have a file of the contacts that carry (result_contacts.vtu: points with force on the source body, normal_force, shear_force, depth, bodies and blocks). Water that loads the model has a file of its free surface (result_water.vtu: velocity at corners).
---@param options cdem.ModelSaveOptions
function Model:save(options) end

---@class (exact) cdem.ModelSaveCracksOptions
---@field file string ends in .vtp, or .vtu for programs that know no .vtp; in the output folder
---@field damaged? boolean default false: faces that soften and have not broken too (mode 0)
---@field series? string ends in .pvd: a time series this file is added to

---Writes broken faces for ParaView as a surface, midway between their sides: displacement at corners; mode (1 tension, 2 shear), damage, opening, slip, time of the last break (nan where it is not known) and body (its number from 0; -1 between two) of faces.
---@param options cdem.ModelSaveCracksOptions
function Model:save_cracks(options) end

---@class (exact) cdem.ModelSaveJointsOptions
---@field file string ends in .vtp, or .vtu for programs that know no .vtp; in the output folder
---@field series? string ends in .pvd: a time series this file is added to
---@field sets? string[] names of joint sets and cuts; all joints when left out
---@field on? cdem.Place default "all": where: one place

---Writes joints between blocks for ParaView as a surface: displacement at corners; set (number in the alphabetical order of all sets, from 1; 0: none), mode (0 bonded, 1 broken in tension, 2 in shear, 3 contact), normal_traction, shear_traction, water_pressure, utilisation, opening, slip and parted (1: left to contact) of faces.
---@param options cdem.ModelSaveJointsOptions
function Model:save_joints(options) end

---@class (exact) cdem.ModelPictureOptionsCamera
---@field position number[] m
---@field focal_point number[] m
---@field up? number[] default {0, 1, 0}
---@field view_angle? number deg, in (0, 180), default 30: over the height of the picture
---@field perspective? boolean default true

---@class (exact) cdem.ModelPictureOptionsFit
---@field min number[] m
---@field max number[] m

---@class (exact) cdem.ModelPictureOptionsMarkers
---@field at number[] m: undeformed place
---@field label? string
---@field colour? number[] {red, green, blue}, each 0 .. 1
---@field size? number > 0, default 14: pixels across

---@class (exact) cdem.ModelPictureOptionsLines
---@field points number[][] m
---@field label? string
---@field colour? number[] {red, green, blue}, each 0 .. 1
---@field width? number > 0, default 4: pixels
---@field dashed? boolean default false

---@class (exact) cdem.ModelPictureOptionsSection
---@field point number[] m
---@field normal number[]

---@class (exact) cdem.ModelPictureOptions
---@field file string ends in .png, .svg or .pdf; in the output folder
---@field colour? string field to colour by, e.g. "displacement.x", "stress.yy", "von_mises", "block_id"; plain blocks when left out
---@field deformation? number default 0: displacements are drawn this many times larger; 0: undeformed
---@field view? "front"|"back"|"left"|"right"|"top"|"bottom"|"iso" default "front": front looks along -z at the x-y plane
---@field up? "y"|"z" z: front looks along y with z up; default: z where gravity acts along z, else y
---@field camera? cdem.ModelPictureOptionsCamera instead of view
---@field fit? cdem.ModelPictureOptionsFit a box that the view shows, in place of what is drawn: give it to all frames of a film, so that the camera does not move with what falls
---@field size? number[] default {1600, 1200}: {width, height} in pixels; height 0: as high as it needs to be
---@field dpi? number in [10, 2400], default 300: pixels in an inch where it is printed: 1600 pixels are 135 mm wide at 300
---@field range? number[] {lowest, highest} of the colours, SI units
---@field colour_map? "auto"|"blue_white_red"|"cool_warm"|"viridis"|"grey"|"categorical" default "auto": auto: blue_white_red when values change sign, viridis when not. Without a range the colours span all values but a few outliers; the legend tells them
---@field title? string _{...} and ^{...} set sub- and superscripts
---@field colour_bar? boolean default true
---@field legend? boolean default true
---@field axes? boolean default true: small arrows that name the directions
---@field scale_bar? boolean default false: a round length under the body; none in perspective
---@field north? number[] the direction of north, {0, 1, 0}: an arrow N beside those of the axes
---@field markers? cdem.ModelPictureOptionsMarkers[]
---@field lines? cdem.ModelPictureOptionsLines[]
---@field plain? string[] names of bodies that are drawn without colour, such as a floor
---@field hidden? string[] names of bodies that are left out, such as a wall
---@field opacity? number in [0.05, 1], default 1: of the blocks; below 1 broken interfaces inside show through
---@field edges? boolean default true: outlines of the blocks
---@field section? cdem.ModelPictureOptionsSection a plane: the cut through the undeformed blocks is drawn in place of their faces
---@field arrows? boolean default false: displacement of the blocks that are shown
---@field crosses? boolean default false: principal stresses of the blocks that are shown, pressure and tension in two colours
---@field joint_sets? string[] with joints: the sets that are drawn; all when left out
---@field joints? boolean default false: the joints alone, within the outline of the bodies, as lines where they are square to the picture; colour is then "slip", "opening", "utilisation", "normal_traction", "shear_traction", "water_pressure", "mode" or "set"
---@field bolts? boolean default true: bolts, drawn over the blocks and coloured by their tension
---@field water? boolean default true: free surface of the water that loads the model (model:flow with water, and the level or table of model:water), as a transparent sheet that tints no coloured body, and the line where it cuts the bodies; in a section its line
---@field water_velocity? boolean default false: velocity of that water as arrows: on its free surface, or in the section where that is upright
---@field broken_bonds? boolean default true: broken interfaces, coloured by how they broke

---Draws the model, without a display.
---@param options cdem.ModelPictureOptions
function Model:picture(options) end

---@class (exact) cdem.ModelFilmOptionsCamera
---@field position number[] m
---@field focal_point number[] m
---@field up? number[] default {0, 1, 0}
---@field view_angle? number deg, in (0, 180), default 30: over the height of the picture
---@field perspective? boolean default true

---@class (exact) cdem.ModelFilmOptionsFit
---@field min number[] m
---@field max number[] m

---@class (exact) cdem.ModelFilmOptionsMarkers
---@field at number[] m: undeformed place
---@field label? string
---@field colour? number[] {red, green, blue}, each 0 .. 1
---@field size? number > 0, default 14: pixels across

---@class (exact) cdem.ModelFilmOptionsLines
---@field points number[][] m
---@field label? string
---@field colour? number[] {red, green, blue}, each 0 .. 1
---@field width? number > 0, default 4: pixels
---@field dashed? boolean default false

---@class (exact) cdem.ModelFilmOptionsSection
---@field point number[] m
---@field normal number[]

---@class (exact) cdem.ModelFilmOptions
---@field file string ends in .ogv, or in .mp4 where ffmpeg is installed; in the output folder
---@field every? number s, > 0: of the model, between frames; relaxations take none
---@field steps? integer >= 1: instead: steps between frames, in relaxations too
---@field frames_per_second? integer in [1, 120], default 12
---@field colour? string field to colour by, e.g. "displacement.x", "stress.yy", "von_mises", "block_id"; plain blocks when left out
---@field deformation? number default 1: displacements are drawn this many times larger; 0: undeformed
---@field view? "front"|"back"|"left"|"right"|"top"|"bottom"|"iso" default "front": front looks along -z at the x-y plane
---@field up? "y"|"z" z: front looks along y with z up; default: z where gravity acts along z, else y
---@field camera? cdem.ModelFilmOptionsCamera instead of view
---@field fit? cdem.ModelFilmOptionsFit a box that all frames show: that of the undeformed model when left out
---@field size? number[] default {1600, 1200}: {width, height} in pixels
---@field dpi? number in [10, 2400], default 300: pixels in an inch where it is printed: 1600 pixels are 135 mm wide at 300
---@field range? number[] {lowest, highest} of the colours, SI units
---@field colour_map? "auto"|"blue_white_red"|"cool_warm"|"viridis"|"grey"|"categorical" default "auto": auto: blue_white_red when values change sign, viridis when not. Without a range the colours span all values but a few outliers; the legend tells them
---@field title? string the time or the step when left out
---@field colour_bar? boolean default true
---@field legend? boolean default true
---@field axes? boolean default true: small arrows that name the directions
---@field scale_bar? boolean default false: a round length under the body; none in perspective
---@field north? number[] the direction of north, {0, 1, 0}: an arrow N beside those of the axes
---@field markers? cdem.ModelFilmOptionsMarkers[]
---@field lines? cdem.ModelFilmOptionsLines[]
---@field plain? string[] names of bodies that are drawn without colour, such as a floor
---@field hidden? string[] names of bodies that are left out, such as a wall
---@field opacity? number in [0.05, 1], default 1: of the blocks; below 1 broken interfaces inside show through
---@field edges? boolean default true: outlines of the blocks
---@field section? cdem.ModelFilmOptionsSection a plane: the cut through the undeformed blocks is drawn in place of their faces
---@field arrows? boolean default false: displacement of the blocks that are shown
---@field crosses? boolean default false: principal stresses of the blocks that are shown, pressure and tension in two colours
---@field joint_sets? string[] with joints: the sets that are drawn; all when left out
---@field joints? boolean default false: the joints alone, within the outline of the bodies, as lines where they are square to the picture; colour is then "slip", "opening", "utilisation", "normal_traction", "shear_traction", "water_pressure", "mode" or "set"
---@field bolts? boolean default true: bolts, drawn over the blocks and coloured by their tension
---@field water? boolean default true: free surface of the water that loads the model (model:flow with water, and the level or table of model:water), as a transparent sheet that tints no coloured body, and the line where it cuts the bodies; in a section its line
---@field water_velocity? boolean default false: velocity of that water as arrows: on its free surface, or in the section where that is upright
---@field broken_bonds? boolean default true: broken interfaces, coloured by how they broke

---Takes a film while the model is solved: a picture now and every so often in the stages that follow (model:run, relax and settle). The film is written when the script ends, fails or is stopped, and goes on when it is resumed; its frames stay in a folder of its name. Give `range` where colours show a field, so that they mean the same in all frames.
---@param options cdem.ModelFilmOptions
function Model:film(options) end

---Writes a checkpoint of the whole run, from which `cdem resume` goes on. One is written every few minutes of a solving call too, and when a run is stopped. A resumed run executes the script again from its beginning. Calls that the script had made return what they returned before, without solving.
function Model:checkpoint() end

---@class (exact) cdem.ModelSaveStateOptions
---@field file string ends in .cdem; in the output folder

---Writes the state of the model to a file that other scripts start from: motion, stress, broken bonds, contacts, time, and how it was cut. Conditions and histories stay behind.
---@param options cdem.ModelSaveStateOptions
function Model:save_state(options) end

---@class (exact) cdem.ModelLoadStateOptions
---@field file string beside the script, in the output folder or below the results

---Takes the state from a file of save_state. The model must have been built from the same shapes, materials, joints and contacts.
---@param options cdem.ModelLoadStateOptions
function Model:load_state(options) end

---@class (exact) cdem.ModelChartOptions
---@field file string ends in .png, .svg or .pdf; in the output folder
---@field y string[] histories, e.g. {"residual"}; model:history() has all
---@field right? string[] histories read on the right
---@field x? string default "step": history along the x axis
---@field stages? boolean over time, a thin line with its name where each stage began; when left out where there are two to eight of them
---@field title? string _{...} and ^{...} set sub- and superscripts
---@field x_label? string ending in an SI unit, "opening (m)", the axis is shown with the prefix that suits: mm
---@field y_label? string
---@field right_label? string of the axis on the right
---@field log_x? boolean default false
---@field log_y? boolean default false
---@field log_right? boolean default false
---@field x_range? number[]
---@field y_range? number[]
---@field right_range? number[]
---@field legend? "auto"|"top_left"|"top_right"|"bottom_left"|"bottom_right"|"none" default "auto"
---@field size? number[] default {1600, 1200}: {width, height} in pixels; height 0: as high as it needs to be
---@field dpi? number in [10, 2400], default 300: pixels in an inch where it is printed: 1600 pixels are 135 mm wide at 300

---Line chart of histories.
---@param options cdem.ModelChartOptions
function Model:chart(options) end

---@class (exact) cdem.ModelChartFragmentsOptions
---@field file string ends in .png, .svg or .pdf; in the output folder
---@field title? string _{...} and ^{...} set sub- and superscripts
---@field x_label? string ending in an SI unit, "opening (m)", the axis is shown with the prefix that suits: mm
---@field y_label? string
---@field right_label? string of the axis on the right
---@field log_x? boolean default true
---@field log_y? boolean default false
---@field log_right? boolean default false
---@field x_range? number[]
---@field y_range? number[]
---@field right_range? number[]
---@field legend? "auto"|"top_left"|"top_right"|"bottom_left"|"bottom_right"|"none" default "auto"
---@field size? number[] default {1600, 1200}: {width, height} in pixels; height 0: as high as it needs to be
---@field dpi? number in [10, 2400], default 300: pixels in an inch where it is printed: 1600 pixels are 135 mm wide at 300

---Chart of the fragments by size: the part of the mass in fragments up to each diameter, that of the sphere with their volume. Held bodies in one piece, such as a floor, are left out.
---@param options cdem.ModelChartFragmentsOptions
function Model:chart_fragments(options) end

---A water table, made by cdem.water_table.
---@class cdem.WaterTable
local WaterTable = {}

---Its z over a place.
---@param x number m
---@param y number m
---@return number? # m; nil beyond the end of a surface
function WaterTable:height(x, y) end

---Units that have left their place, in order: grows while the model runs.
---@class cdem.Watch
---@field [integer] cdem.Departure
---@operator len: integer
local Watch = {}

---A field of water, made by cdem.water.*; what model:flow takes as `water`.
---@class cdem.Water
---@field density number kg/m3
---@field run_up? number m: highest z that is wet at any time; on a slope only
---@field run_down? number m: lowest z of the water line; on a slope only
local Water = {}

---Velocity, acceleration, pressure and surface at a place and time.
---@param place number[] m
---@param time? number s, default 0
---@return cdem.WaterPoint
function Water:at(place, time) end

---@class (exact) cdem.ParameterOptions
---@field name string a word, as in --set pressure=24e6
---@field default any value without --set; its type is the parameter's
---@field type? "number"|"integer"|"string"|"boolean"|"list" only needed to let an integer default take any number
---@field range? number[] {lowest, highest} allowed, for numbers and every item of a list
---@field choices? (string|number|boolean)[] the values allowed
---@field unit? string e.g. "Pa"
---@field doc? string one sentence, shown by `cdem check`

---Declares a value that the command line can change with --set name=value, and returns it. Its type is that of the default: number, integer, string, boolean or list. Parameters come before the first solving call.
---@param options cdem.ParameterOptions
---@return any # the value
function cdem.parameter(options) end

---@class (exact) cdem.ElasticOptionsDamping
---@field fraction number in (0, 1): of critical damping at the frequency
---@field frequency number Hz, > 0
---@field of? "both"|"mass"|"stiffness" default "both": half of it each, and more at other frequencies; or all by viscosity (falls with the frequency, holds back motion as a rigid body); or all by stiffness_damping (grows with the frequency, shortens the stable step)

---@class (exact) cdem.ElasticOptions
---@field youngs_modulus number Pa, > 0: Young's modulus E
---@field poissons_ratio number in (-1, 0.5): Poisson's ratio nu
---@field density number kg/m3, > 0
---@field viscosity? number N s/m4, >= 0, default 0: damping force per volume and velocity, mu of Han 2010 eq 1; used by real-time stepping
---@field stiffness_damping? number s, >= 0, default 0: beta of Rayleigh damping, of meshes in real-time stepping: a vibration of angular frequency w has beta w / 2 of critical damping, motion as a rigid body none
---@field damping? cdem.ElasticOptionsDamping Rayleigh damping by the fraction of critical damping, in place of viscosity and stiffness_damping

---Isotropic linear elasticity (Han 2010 eq 3).
---@param options cdem.ElasticOptions
---@return cdem.Material
function cdem.elastic(options) end

---@class (exact) cdem.PlasticOptions
---@field cohesion number Pa, >= 0
---@field friction_angle number deg, in [0, 90)
---@field tensile_strength number Pa, >= 0: what is beyond the tip of the cone, cohesion / tan(friction_angle), does not act
---@field dilation_angle? number deg, in [0, 90), default 0: at most friction_angle
---@field residual_cohesion? number Pa, >= 0: at softening_strain; the peak's when left out
---@field residual_friction_angle? number deg, in [0, 90)
---@field residual_tensile_strength? number Pa, >= 0
---@field softening_strain? number > 0: equivalent plastic strain at which the residual strength is reached, linearly; without fracture energy, so that what it dissipates depends on the size of the elements

---Mohr-Coulomb plasticity with tension cut-off, dilation and softening, of the tetrahedra of blocks and meshes (docs/theory.md, section 25).
---@param options cdem.PlasticOptions
---@return cdem.Plasticity
function cdem.plastic(options) end

---@class (exact) cdem.MohrCoulombOptionsWeibull
---@field modulus number in [2, 1000]: m
---@field reference_volume number m3, > 0: the volume whose mean strength the joint gives
---@field seed integer >= 0

---@class (exact) cdem.MohrCoulombOptionsRate_effect
---@field reference_rate number 1/s, > 0: of the strengths given
---@field exponent number in [0, 1]
---@field change_rate? number 1/s, > 0: beyond it exponent_above holds
---@field exponent_above? number in [0, 1]
---@field fracture_energy? boolean default false: fracture energies are raised too

---@class (exact) cdem.MohrCoulombOptions
---@field cohesion number Pa, >= 0
---@field friction_angle number deg, in [0, 90)
---@field tensile_strength number Pa, >= 0
---@field residual_cohesion? number Pa, >= 0: between blocks: cohesion of a broken joint whose faces press; at most cohesion
---@field residual_tensile_strength? number Pa, >= 0: between blocks: pull of a broken joint, however far it opens; at most tensile_strength
---@field residual_friction_angle? number deg, in [0, 90): between blocks: friction once the joint has slipped; at most friction_angle, which it is when left out
---@field dilation_angle? number deg, in [0, 90): between blocks: slip opens the joint at this angle; at most the residual friction angle
---@field dilation_limit? number m, >= 0: slip at which dilation ends; without it it does not end
---@field softening? "none"|"linear"|"exponential" default "none": how the strength falls once it is reached; none: brittle. It needs both fracture energies, and tensile_strength at most cohesion / tan(friction angle)
---@field fracture_energy_1? number J/m2, > 0: G_I, work per crack area that opening to separation takes, elastic part included
---@field fracture_energy_2? number J/m2, > 0: G_II, the same for slip, beyond the work of friction
---@field weibull? cdem.MohrCoulombOptionsWeibull strength that scatters from face to face after Weibull: tensile strength and cohesion of a face are multiplied by one draw, in the mean (reference_volume / volume of the face)^(1/m); fracture energies and friction stay. A draw depends on the seed and on where the face lies
---@field rate_effect? cdem.MohrCoulombOptionsRate_effect strength raised by the rate of strain at which a face of a cohesive body begins to crack, (rate / reference_rate)^exponent; fib Model Code 2010 for concrete in tension: 1e-6, 0.018, 10, 1/3
---@field thickness_ratio? number > 0, default 0.02: equivalent thickness of the joint over the block size (cube root of its volume), which sets the stiffness E/L and G/L
---@field thickness? number m, > 0: equivalent thickness itself; wins over the ratio. Contacts of meshes take it too
---@field normal_stiffness? number Pa/m, > 0: instead of E/L
---@field shear_stiffness? number Pa/m, > 0: instead of G/L
---@field stiffness_damping? number s, >= 0, default 0: beta of Rayleigh damping, of joints between blocks that move far in real-time stepping, as long as their faces have not parted; refused where it would do nothing

---Bond between block faces. It breaks in tension above the tensile strength, and in shear above cohesion + normal pressure x tan(friction angle). Then it is a contact with the same friction angle, or with the residual strength that is given (Han 2010 eqs 8-11). With softening it loses its strength along a curve whose area is the fracture energy.
---@param options cdem.MohrCoulombOptions
---@return cdem.Joint
function cdem.mohr_coulomb(options) end

---@class (exact) cdem.CoulombOptions
---@field friction_angle number deg, in [0, 90)
---@field residual_friction_angle? number deg, in [0, 90): between blocks: friction once the joint has slipped; at most friction_angle, which it is when left out
---@field dilation_angle? number deg, in [0, 90): between blocks: slip opens the joint at this angle; at most the residual friction angle
---@field dilation_limit? number m, >= 0: slip at which dilation ends; without it it does not end
---@field thickness_ratio? number > 0, default 0.02: equivalent thickness of the joint over the block size (cube root of its volume), which sets the stiffness E/L and G/L
---@field thickness? number m, > 0: equivalent thickness itself; wins over the ratio. Contacts of meshes take it too
---@field normal_stiffness? number Pa/m, > 0: instead of E/L
---@field shear_stiffness? number Pa/m, > 0: instead of G/L
---@field stiffness_damping? number s, >= 0, default 0: beta of Rayleigh damping, of joints between blocks that move far in real-time stepping, as long as their faces have not parted; refused where it would do nothing
---@field restitution? number in [0.01, 1], default 1: coefficient of restitution of the contact of bodies that move far: speed after over speed before an impact, as far as the contact and not waves within the bodies decide it; 1: the contact loses nothing but by friction

---Contact that never was bonded: no tension, friction only (Han 2010 eq 9).
---@param options cdem.CoulombOptions
---@return cdem.Joint
function cdem.coulomb(options) end

---@class (exact) cdem.GluedOptions
---@field thickness_ratio? number > 0, default 0.005: equivalent thickness of the joint over the block size (cube root of its volume), which sets the stiffness E/L and G/L
---@field thickness? number m, > 0: equivalent thickness itself; wins over the ratio. Contacts of meshes take it too
---@field normal_stiffness? number Pa/m, > 0: instead of E/L
---@field shear_stiffness? number Pa/m, > 0: instead of G/L
---@field stiffness_damping? number s, >= 0, default 0: beta of Rayleigh damping, of joints between blocks that move far in real-time stepping, as long as their faces have not parted; refused where it would do nothing

---Bond that never breaks, of faces that are no joint, such as those of an excavation outline. It is four times as stiff as a joint by default.
---@param options? cdem.GluedOptions
---@return cdem.Joint
function cdem.glued(options) end

---@class (exact) cdem.HoekBrownOptionsResidual
---@field gsi? number in [5, 100]
---@field m_i? number > 0
---@field disturbance? number in [0, 1]
---@field tensile_strength? number Pa, >= 0

---@class (exact) cdem.HoekBrownOptions
---@field sigma_ci number Pa, > 0: uniaxial compressive strength of the intact rock
---@field gsi number in [5, 100]: geological strength index; 100 is intact rock
---@field m_i number > 0: constant of the intact rock, 4 for claystone to 33 for granite
---@field disturbance? number in [0, 1], default 0: D: 0 is undisturbed rock, 1 poor blasting
---@field tensile_strength? number Pa, >= 0: at most that of the curve in uniaxial tension, which is the default
---@field dilation_angle? number deg, in [0, 90), default 0: at most the friction angle of the tangent
---@field residual? cdem.HoekBrownOptionsResidual of the rock at softening_strain; what is left out stays
---@field softening_strain? number > 0: equivalent plastic strain at which the residual strength is reached, linearly; without fracture energy, so that what it dissipates depends on the size of the elements

---Plasticity by the generalised Hoek-Brown strength of a rock mass (Hoek, Carranza-Torres and Corkum 2002), with tension cut-off, dilation and softening (docs/theory.md, section 25).
---@param options cdem.HoekBrownOptions
---@return cdem.Plasticity
function cdem.hoek_brown(options) end

---@class (exact) cdem.HoekBrownBondOptions
---@field sigma_ci number Pa, > 0: uniaxial compressive strength of the intact rock
---@field gsi number in [5, 100]: geological strength index; 100 is intact rock
---@field m_i number > 0: constant of the intact rock, 4 for claystone to 33 for granite
---@field disturbance? number in [0, 1], default 0: D: 0 is undisturbed rock, 1 poor blasting
---@field tensile_strength? number Pa, >= 0: at most that of the curve in uniaxial tension, which is the default
---@field friction_angle number deg, in [0, 90): of a crack, once it has begun

---Brittle strength of a cohesive body (bonds = "cohesive") by the generalised Hoek-Brown curve: a face cracks where the stress meets the curve, on the plane of its tangent (docs/theory.md, section 22).
---@param options cdem.HoekBrownBondOptions
---@return cdem.Joint
function cdem.hoek_brown_bond(options) end

---@class (exact) cdem.BartonBandisOptions
---@field jrc number in [0, 20]: joint roughness coefficient
---@field jcs number Pa, > 0: strength of the joint walls
---@field residual_friction_angle number deg, in [0, 70): phi_r
---@field initial_stiffness number Pa/m, > 0: slope of the hyperbola where it begins; normal_stiffness, or E/L, is the steepest it becomes
---@field maximum_closure number m, > 0
---@field length? number m, > 0: of the joint: jrc and jcs are those of samples and are scaled to it, and it gives the slip at the peak, length / 500 (JRC / length)^0.33
---@field sample_length? number m, > 0, default 0.1: of the samples
---@field peak_slip? number m, > 0: slip at the peak; wins over that of the length
---@field thickness_ratio? number > 0, default 0.02: equivalent thickness of the joint over the block size (cube root of its volume), which sets the stiffness E/L and G/L
---@field thickness? number m, > 0: equivalent thickness itself; wins over the ratio. Contacts of meshes take it too
---@field normal_stiffness? number Pa/m, > 0: instead of E/L
---@field shear_stiffness? number Pa/m, > 0: instead of G/L
---@field stiffness_damping? number s, >= 0, default 0: beta of Rayleigh damping, of joints between blocks that move far in real-time stepping, as long as their faces have not parted; refused where it would do nothing

---Rough joint between blocks that never was bonded (Barton and Choubey 1977, Bandis et al. 1983): it closes on a hyperbola and slips above pressure x tan(residual angle + JRC log10(JCS / pressure)). With a length, or peak_slip, the roughness is mobilised and worn with slip, and the joint dilates.
---@param options cdem.BartonBandisOptions
---@return cdem.Joint
function cdem.barton_bandis(options) end

---@class (exact) cdem.JointTableOptions
---@field normal? [number, number][] rows {closure (m), pressure (Pa)} that rise, one of them {0, 0}; rows below it are {-opening, -pull}, up to the opening at which the joint parts. Without rows it is linear
---@field shear [number, number][] rows {pressure (Pa), strength (Pa)}, the first {0, strength without pressure}
---@field thickness_ratio? number > 0, default 0.02: equivalent thickness of the joint over the block size (cube root of its volume), which sets the stiffness E/L and G/L
---@field thickness? number m, > 0: equivalent thickness itself; wins over the ratio. Contacts of meshes take it too
---@field normal_stiffness? number Pa/m, > 0: instead of E/L
---@field shear_stiffness? number Pa/m, > 0: instead of G/L
---@field stiffness_damping? number s, >= 0, default 0: beta of Rayleigh damping, of joints between blocks that move far in real-time stepping, as long as their faces have not parted; refused where it would do nothing

---Joint between blocks that never was bonded, by tables: straight between rows, straight on beyond the last.
---@param options cdem.JointTableOptions
---@return cdem.Joint
function cdem.joint_table(options) end

---@class (exact) cdem.GridOptions
---@field size number[] m, > 0: of the whole
---@field divisions number[] >= 1: boxes along x, y and z
---@field origin? number[] m, default {0, 0, 0}: lower corner

---A box of equal boxes in rows.
---@param options cdem.GridOptions
---@return cdem.Assembly
function cdem.grid(options) end

---@class (exact) cdem.BoxOptions
---@field size number[] m, > 0
---@field origin? number[] m, default {0, 0, 0}: lower corner

---One box.
---@param options cdem.BoxOptions
---@return cdem.Assembly
function cdem.box(options) end

---@class (exact) cdem.VoronoiOptions
---@field size number[] m, > 0: of the whole
---@field count integer >= 1: number of blocks
---@field seed? integer >= 0, default 1: the same seed gives the same blocks on every machine
---@field relaxations? integer in [0, 1000], default 3: Lloyd steps: each moves the points to their cells' centroids, which evens the cells out
---@field extruded? boolean default false: cells in x and y, one block through z
---@field origin? number[] m, default {0, 0, 0}: lower corner

---A box of Voronoi cells about seeded random points.
---@param options cdem.VoronoiOptions
---@return cdem.Assembly
function cdem.voronoi(options) end

---@class (exact) cdem.BricksOptions
---@field size number[] m, > 0: of the wall
---@field brick number[] m, > 0: one brick
---@field shift? number in [0, 1), default 0.5: of each course against the one below, as a fraction of the brick's length
---@field origin? number[] m, default {0, 0, 0}: lower corner

---A wall in running bond: courses laid along z, bricks running along x, the end bricks cut.
---@param options cdem.BricksOptions
---@return cdem.Assembly
function cdem.bricks(options) end

---@class (exact) cdem.CutByJointsOptionsSets
---@field dip number deg, in [0, 90]: below the horizontal plane, z up
---@field dip_direction number deg, in [0, 360]: clockwise from +y (north) seen from above
---@field spacing number m, > 0: mean, along the normal
---@field spacing_scatter? number in [0, 0.5), default 0: standard deviation over the mean
---@field dip_scatter? number deg, in [0, 90], default 0: standard deviation
---@field direction_scatter? number deg, in [0, 360], default 0: standard deviation
---@field origin? number[] m: a plane runs through it; without it the planes are counted from the lowest corner of the blocks along the normal
---@field count? integer >= 1: planes next to the origin, on both sides of it; next to the centre of the blocks where no origin is given. As many as cross the blocks when left out
---@field persistence? number in [0, 1], default 1: probability that a face belongs to the set, above 0. The other faces are bridges of rock, which the body's joint holds; each face between two blocks is drawn by itself. Needs a name
---@field name? string of the set, for its law: a body's joints = { name = joint }

---@class (exact) cdem.CutByJointsOptions
---@field shape cdem.Assembly
---@field sets cdem.CutByJointsOptionsSets[]
---@field seed? integer >= 0, default 1: the same seed gives the same blocks on every machine
---@field smallest? number m, >= 0, default 0: blocks whose least height over a face is smaller are splinters, which fail before the rock does and shorten the time step. A splinter is united with a neighbour if both together are convex. Otherwise one of its faces is glued to a neighbour. Glued cuts are left as they are: a splinter joins no neighbour across one

---Cuts every block by the planes of joint sets, one set after the other, those with a persistence below 1 last.
---@param options cdem.CutByJointsOptions
---@return cdem.Assembly
function cdem.cut_by_joints(options) end

---@class (exact) cdem.CutByDiscsOptionsDiscs
---@field id? integer >= 0: discs cut in the order of their ids; its place in the list when left out
---@field centre number[] m
---@field dip number deg, in [0, 90]
---@field dip_direction number deg, in [0, 360]
---@field radius number m, > 0
---@field set string name of its faces, for their law

---@class (exact) cdem.CutByDiscsOptions
---@field shape cdem.Assembly
---@field discs cdem.CutByDiscsOptionsDiscs[]
---@field clearance? number m, >= 0: a cut that comes nearer to a corner of its block than this without running through it is moved away, since thin blocks fail early and shorten the time step; 0 cuts exactly; 1e-3 of each block's diagonal when left out. What is moved is told

---Joints of finite size: every block that a disc reaches is cut by the disc's plane. Faces with their centroid in the disc belong to its set; beyond it they are bridges of rock, which the body's joint holds.
---@param options cdem.CutByDiscsOptions
---@return cdem.Assembly
function cdem.cut_by_discs(options) end

---Discs of a fracture network from a .csv with the columns id, x, y, z, dip, dip_direction, radius and set, in any order, for cut_by_discs.
---@param file string
---@return table[] # id, centre, dip, dip_direction, radius and set of each
function cdem.read_discs(file) end

---@class (exact) cdem.ConvexHullOptions
---@field points number[][] m: four or more, not in one plane

---One block: the convex hull of points.
---@param options cdem.ConvexHullOptions
---@return cdem.Assembly
function cdem.convex_hull(options) end

---@class (exact) cdem.BlocksOptions
---@field mesh cdem.TetMesh

---Every tetrahedron of a mesh as a block: blocks whose tetrahedra share a face share it too, so that they can be bonded, cut and come loose.
---@param options cdem.BlocksOptions
---@return cdem.Assembly
function cdem.blocks(options) end

---@class (exact) cdem.CutByPlaneOptionsInside
---@field min number[] m
---@field max number[] m

---@class (exact) cdem.CutByPlaneOptionsCrossing
---@field min number[] m
---@field max number[] m

---@class (exact) cdem.CutByPlaneOptions
---@field shape cdem.Assembly left as it is; the result is a new one
---@field point number[] m: any point of the plane
---@field normal number[] of any length
---@field inside? cdem.CutByPlaneOptionsInside only blocks whose centroid lies in this box
---@field crossing? cdem.CutByPlaneOptionsCrossing only blocks that reach into this box: the notch or the load line to be cut
---@field clearance? number m, >= 0, default 0: where a vertex of a block is nearer than this, the plane is shifted for that block
---@field name? string of the cut, for its law: a body's joints = { name = joint }
---@field glued? boolean default false: a construction cut, such as an excavation outline: no joint; its faces hold the rock together, stiff and unbreakable, whatever the body's joint. Where it runs along a joint that is there already, the joint stays

---Splits every block that a plane crosses.
---@param options cdem.CutByPlaneOptions
---@return cdem.Assembly
function cdem.cut_by_plane(options) end

---@class (exact) cdem.KeepOptionsInside
---@field min number[] m
---@field max number[] m

---@class (exact) cdem.KeepOptions
---@field shape cdem.Assembly left as it is; the result is a new one
---@field inside cdem.KeepOptionsInside

---The blocks whose centroid lies in a box.
---@param options cdem.KeepOptions
---@return cdem.Assembly
function cdem.keep(options) end

---@class (exact) cdem.TranslateOptions
---@field shape cdem.Assembly left as it is; the result is a new one
---@field shift number[] m

---Moves blocks.
---@param options cdem.TranslateOptions
---@return cdem.Assembly
function cdem.translate(options) end

---@class (exact) cdem.RotateOptions
---@field shape cdem.Assembly left as it is; the result is a new one
---@field axis number[] of any length
---@field angle number deg
---@field centre? number[] m, default {0, 0, 0}

---Turns blocks, right-handed, about an axis through `centre`.
---@param options cdem.RotateOptions
---@return cdem.Assembly
function cdem.rotate(options) end

---@class (exact) cdem.MergeOptions
---@field shapes cdem.Assembly[]

---One assembly of the blocks of several.
---@param options cdem.MergeOptions
---@return cdem.Assembly
function cdem.merge(options) end

---@class (exact) cdem.RandomDiscsOptionsSetsRadius
---@field law? "constant"|"exponential"|"lognormal"|"power" default "constant"
---@field mean? number m, > 0: of constant, exponential and lognormal
---@field deviation? number m, > 0: standard deviation, of lognormal
---@field exponent? number in [0.01, 20]: a of power: the density falls as radius^-(a + 1)
---@field smallest? number m, > 0: of power
---@field largest? number m, > 0: of power

---@class (exact) cdem.RandomDiscsOptionsSets
---@field set string its name
---@field dip number deg, in [0, 90]: of the mean plane
---@field dip_direction number deg, in [0, 360]
---@field kappa? number > 0: concentration of Fisher's distribution, some 10 to 100; all discs are parallel when left out
---@field radius cdem.RandomDiscsOptionsSetsRadius
---@field p30? number 1/m3, > 0: discs per volume
---@field p32? number 1/m, > 0: instead: area of discs per volume

---@class (exact) cdem.RandomDiscsOptionsBox
---@field min number[] m
---@field max number[] m

---@class (exact) cdem.RandomDiscsOptions
---@field sets cdem.RandomDiscsOptionsSets[]
---@field box cdem.RandomDiscsOptionsBox of the centres
---@field seed? integer >= 0, default 1: the same seed gives the same discs on every machine

---A fracture network at random, for cut_by_discs: discs with centres even in a box, orientation after Fisher, and a law of radii. Take the box larger than the rock by the largest radius, or the discs thin out at its sides.
---@param options cdem.RandomDiscsOptions
---@return table[] # id, centre, dip, dip_direction, radius and set of each
function cdem.random_discs(options) end

---@class (exact) cdem.DiscStatisticsOptionsDiscs
---@field id? integer >= 0: discs cut in the order of their ids; its place in the list when left out
---@field centre number[] m
---@field dip number deg, in [0, 90]
---@field dip_direction number deg, in [0, 360]
---@field radius number m, > 0
---@field set string name of its faces, for their law

---@class (exact) cdem.DiscStatisticsOptionsBox
---@field min number[] m
---@field max number[] m

---@class (exact) cdem.DiscStatisticsOptionsPlane
---@field point number[] m
---@field normal number[]

---@class (exact) cdem.DiscStatisticsOptionsLine
---@field from number[] m
---@field to number[] m

---@class (exact) cdem.DiscStatisticsOptions
---@field discs cdem.DiscStatisticsOptionsDiscs[]
---@field box cdem.DiscStatisticsOptionsBox the volume
---@field plane? cdem.DiscStatisticsOptionsPlane for p21: a rock face or the floor of a drift
---@field line? cdem.DiscStatisticsOptionsLine for p10: a scanline or a borehole

---Intensities and mean orientation of discs, a row for each set: of cdem.random_discs, or as surveyed, of cdem.read_discs.
---@param options cdem.DiscStatisticsOptions
---@return cdem.DiscStatistics[]
function cdem.disc_statistics(options) end

cdem.solid = {}

---@class (exact) cdem.SolidBoxOptions
---@field size number[] m, > 0
---@field origin? number[] m, default {0, 0, 0}: lower corner

---A box.
---@param options cdem.SolidBoxOptions
---@return cdem.Solid
function cdem.solid.box(options) end

---@class (exact) cdem.SolidCylinderOptions
---@field radius number m, > 0
---@field axis number[] m: from the middle of the base to that of the top
---@field base? number[] m, default {0, 0, 0}: middle of the base

---A cylinder.
---@param options cdem.SolidCylinderOptions
---@return cdem.Solid
function cdem.solid.cylinder(options) end

---@class (exact) cdem.SolidConeOptions
---@field radius number m, >= 0: of the base
---@field top_radius? number m, >= 0, default 0
---@field axis number[] m: from the middle of the base to that of the top
---@field base? number[] m, default {0, 0, 0}: middle of the base

---A cone, cut off at the top unless top_radius is 0.
---@param options cdem.SolidConeOptions
---@return cdem.Solid
function cdem.solid.cone(options) end

---@class (exact) cdem.SolidSphereOptions
---@field radius number m, > 0
---@field centre? number[] m, default {0, 0, 0}

---A ball.
---@param options cdem.SolidSphereOptions
---@return cdem.Solid
function cdem.solid.sphere(options) end

---@class (exact) cdem.SolidReadOptions
---@field file string ends in .step, .stp, .stl, .obj, .off, .ply, .dxf or .ts
---@field scale? number in [1e-06, 1e+06], default 1: 0.001 for a file in millimetres
---@field shift? number[] m, default {0, 0, 0}: is added to the coordinates: a survey far from the origin loses its digits

---A solid from a STEP file (in the file's units), or from a closed surface of triangles (STL, OBJ, OFF, PLY, DXF, GOCAD). Each triangle becomes a face of the solid, so no element of its mesh is larger than the triangles. Triangles without area and T-junctions are mended, which is told.
---@param options cdem.SolidReadOptions
---@return cdem.Solid
function cdem.solid.read(options) end

---@class (exact) cdem.SolidUnionOptions
---@field solids cdem.Solid[]

---All of several solids as one.
---@param options cdem.SolidUnionOptions
---@return cdem.Solid
function cdem.solid.union(options) end

---@class (exact) cdem.SolidCutOptions
---@field solid cdem.Solid left as it is; the result is a new one
---@field tools cdem.Solid[] what is taken away

---A solid without the parts that others cover.
---@param options cdem.SolidCutOptions
---@return cdem.Solid
function cdem.solid.cut(options) end

---@class (exact) cdem.SolidCommonOptions
---@field solid cdem.Solid left as it is; the result is a new one
---@field other cdem.Solid

---What two solids have in common.
---@param options cdem.SolidCommonOptions
---@return cdem.Solid
function cdem.solid.common(options) end

---@class (exact) cdem.SolidFragmentsOptions
---@field solids cdem.Solid[]

---The pieces that solids cut each other into, as regions of one solid; neighbours share faces, and their meshes share nodes.
---@param options cdem.SolidFragmentsOptions
---@return cdem.Solid
function cdem.solid.fragments(options) end

---@class (exact) cdem.ReadSurfaceOptions
---@field file string ends in .stl, .dxf, .obj, .off, .ply or .ts
---@field scale? number in [1e-06, 1e+06], default 1: 0.001 for a file in millimetres
---@field shift? number[] m, default {0, 0, 0}: is added to the coordinates: a survey far from the origin loses its digits

---A surface of triangles from a file: STL, ASCII DXF (3DFACE, polyface and polygon meshes), OBJ, OFF, PLY or GOCAD; a terrain, an excavation. Triangles without area and T-junctions are mended, which is told.
---@param options cdem.ReadSurfaceOptions
---@return cdem.Surface
function cdem.read_surface(options) end

---@class (exact) cdem.SurfaceOptions
---@field points number[][] m
---@field triangles [number, number, number][] numbers of three points each, from 1

---A surface of triangles by its points: a terrain by a formula or from a table.
---@param options cdem.SurfaceOptions
---@return cdem.Surface
function cdem.surface(options) end

---@class (exact) cdem.ClipOptions
---@field shape cdem.Assembly left as it is; the result is a new one
---@field solid? cdem.Solid
---@field surface? cdem.Surface instead: closed, or open and single in height, a terrain
---@field keep "inside"|"outside"|"below"|"above"|"both" inside and outside of a closed surface or a solid, below and above an open one; both: only cut, the outline of a later excavation (model:remove)
---@field tolerance? number m, >= 0, default 0: how far the cuts may leave the surface; makes fewer pieces and no thinner ones. 0: exact; curved solids need one
---@field name? string of the faces that are cut, in pictures of joints, lists and `joints` of a body
---@field glued? boolean default true: true: the cuts are no joints, and their faces never break. false: they are joints, as the faces of cdem.cut_by_plane are. A cut that runs on through the rest of a block, where the surface bends inside it, is a joint there too; so a fault can follow a surface

---Cuts blocks along a surface or the faces of a solid, and keeps those on one side. Each block is cut by planes into convex pieces; the cuts within it are glued unless told otherwise.
---@param options cdem.ClipOptions
---@return cdem.Assembly
function cdem.clip(options) end

---@class (exact) cdem.AccropodeOptions
---@field height? number m, > 0
---@field mass? number kg, > 0: with density, instead of height: the volume is met exactly
---@field density? number kg/m3, > 0
---@field mesh_size? number m, > 0: what solid:mesh{} takes when it is given no size
---@field shape? "slender"|"stocky" default "slender"
---@field width? number > 0: of the end bars and the core along x: 0.42 or 0.386
---@field bar? number > 0: of an end bar along y: 0.33 or 0.30
---@field core? number > 0: of the core and the middle bar along z: 0.42
---@field length? number > 0: of the middle bar along x: 1 or 0.80
---@field taper? number > 0: size of a bar's end over that at the core: 0.70 or 0.95
---@field corner? number >= 0: cut off a bar's edges, over the shorter side of its section: 0.20; 0: square bars, which make larger tetrahedra

---An accropode-like unit, V = 0.34 H^3: two end bars along z, a middle bar along x, a core. Centred on the origin. Proportions are fractions of the height; those left out are the shape's.
---@param options? cdem.AccropodeOptions
---@return cdem.Solid
function cdem.accropode(options) end

---@class (exact) cdem.DolosOptions
---@field height? number m, > 0
---@field mass? number kg, > 0: with density, instead of height: the volume is met exactly
---@field density? number kg/m3, > 0
---@field mesh_size? number m, > 0: what solid:mesh{} takes when it is given no size
---@field tip? number > 0, default 0.2: width of a fluke at its ends, over the height
---@field waist? number > 0, default 0.32: width of the shank, over the height
---@field root? number > 0, default 0.364: width of a fluke at its middle, over the height

---A dolos without fillets, V = 0.163 C^3: octagonal flukes along z and y at the ends of a shank along x.
---@param options? cdem.DolosOptions
---@return cdem.Solid
function cdem.dolos(options) end

---@class (exact) cdem.TetrapodOptions
---@field height? number m, > 0
---@field mass? number kg, > 0: with density, instead of height: the volume is met exactly
---@field density? number kg/m3, > 0
---@field mesh_size? number m, > 0: what solid:mesh{} takes when it is given no size
---@field tip? number > 0, default 0.302: diameter of a leg at its end, over the height
---@field root? number > 0, default 0.47: diameter of a leg where it meets the others

---A tetrapod, V = 0.28 H^3: four conical legs, one of them up.
---@param options? cdem.TetrapodOptions
---@return cdem.Solid
function cdem.tetrapod(options) end

---@class (exact) cdem.CubeOptions
---@field height? number m, > 0
---@field mass? number kg, > 0: with density, instead of height: the volume is met exactly
---@field density? number kg/m3, > 0
---@field mesh_size? number m, > 0: what solid:mesh{} takes when it is given no size

---A plain cube.
---@param options? cdem.CubeOptions
---@return cdem.Solid
function cdem.cube(options) end

---@class (exact) cdem.AntiferOptions
---@field height? number m, > 0
---@field mass? number kg, > 0: with density, instead of height: the volume is met exactly
---@field density? number kg/m3, > 0
---@field mesh_size? number m, > 0: what solid:mesh{} takes when it is given no size
---@field bottom? number > 0, default 1.086: width of the lower face, over the height
---@field top? number > 0, default 1.005: width of the upper face
---@field groove? number >= 0, default 0.1047: radius of the grooves; 0: none

---An antifer cube, V = 1.0247 H^3: its sides lean in and have a round groove each.
---@param options? cdem.AntiferOptions
---@return cdem.Solid
function cdem.antifer(options) end

---@class (exact) cdem.CubipodOptions
---@field height? number m, > 0
---@field mass? number kg, > 0: with density, instead of height: the volume is met exactly
---@field density? number kg/m3, > 0
---@field mesh_size? number m, > 0: what solid:mesh{} takes when it is given no size
---@field cube? number > 0, default 0.74: side of the cube
---@field root? number > 0, default 0.48: width of a pyramid on the cube
---@field tip? number > 0, default 0.36: width of its end

---A cube with a truncated pyramid on each side, as the Cubipod has; V = 0.544 H^3, H from tip to tip. Proportions are fractions of the height, and ours.
---@param options? cdem.CubipodOptions
---@return cdem.Solid
function cdem.cubipod(options) end

---@class (exact) cdem.SlopeOptions
---@field gradient number > 0: rise over run: 1/1.5
---@field length number m, > 0: along x
---@field width number m, > 0: along y
---@field mesh_size? number m, > 0

---A wedge that rises along +x from x = 0, z = 0; y from -width/2 to width/2.
---@param options cdem.SlopeOptions
---@return cdem.Solid
function cdem.slope(options) end

---@class (exact) cdem.ReadMeshOptions
---@field file string
---@field regions? string what parts the mesh into regions: "physical" groups or "volumes" of gmsh, "sections" or element "sets" of Abaqus, the name of a cell array of VTK; chosen and told when left out
---@field scale? number in [1e-06, 1e+06], default 1: 0.001 for a mesh in millimetres
---@field shift? number[] m, default {0, 0, 0}: is added to the coordinates: a survey far from the origin loses its digits

---Linear tetrahedra from a file: gmsh .msh, Medit .mesh, Nastran .bdf, I-deas .unv, Abaqus .inp, .vtk or .vtu. What is wrong with them is said.
---@param options cdem.ReadMeshOptions
---@return cdem.TetMesh
function cdem.read_mesh(options) end

---@class (exact) cdem.BoxMeshOptions
---@field size number[] m, > 0
---@field divisions number[] >= 1: cells along x, y and z
---@field jitter? number in [0, 0.16], default 0: inner nodes move along each axis by up to this share of a cell
---@field seed? integer >= 0, default 1: of the jitter

---A box of nx ny nz cells with six tetrahedra each; lower corner at the origin.
---@param options cdem.BoxMeshOptions
---@return cdem.TetMesh
function cdem.box_mesh(options) end

---@class (exact) cdem.ShellMeshOptions
---@field surface cdem.Surface cdem.read_surface or cdem.surface
---@field thickness number m, > 0: more than bodies reach into it and move in a step; less than the surface is bent
---@field front? number[] m: a place on the side that bodies touch, such as the middle of a drum; where the triangles' normals point when left out

---An open surface as a wall, such as a drum, a funnel, a chute or a terrain: the mesh of a rigid body that is held. The surface is one side of the wall; the other side lies behind it.
---@param options cdem.ShellMeshOptions
---@return cdem.TetMesh
function cdem.shell_mesh(options) end

---@class (exact) cdem.DropOptionsRegion
---@field min number[]
---@field max number[]

---@class (exact) cdem.DropOptions
---@field unit cdem.TetMesh a unit's mesh
---@field count integer in [1, 1e+06]: how many units
---@field onto cdem.TetMesh the ground, z up; a slope's mesh
---@field region? cdem.DropOptionsRegion part of the ground's plan, corners {x, y}; all of it when left out
---@field seed? integer >= 0, default 1: of the attitudes
---@field gap? number m, > 0: between the spheres around units, and under the lowest layer; a tenth of the unit's height
---@field layers? integer in [1, 20]: on top of each other; as few as the region allows when left out

---Units that hang over the ground in random attitudes, to be dropped. They hang on a grid in the middle of the region, so far apart that they are clear of each other in every attitude. Rows run across the rise of the ground, the lowest first.
---@param options cdem.DropOptions
---@return cdem.Pile
function cdem.drop(options) end

---@class (exact) cdem.PlaceOptionsRegion
---@field min number[]
---@field max number[]

---@class (exact) cdem.PlaceOptions
---@field unit cdem.TetMesh a unit's mesh
---@field count integer in [1, 1e+06]: how many units
---@field onto cdem.TetMesh the ground, z up; a slope's mesh
---@field region? cdem.PlaceOptionsRegion part of the ground's plan, corners {x, y}; all of it when left out
---@field seed? integer >= 0, default 1: of the attitudes
---@field density? number in [0.05, 1.5], default 0.645: phi = N Dn^2 / A, units on an area of slope times that of their equal cube's side
---@field columns? integer >= 1: units in a row; as many as the region allows when left out
---@field gap? number m, > 0: clear distance; 2e-5 of the unit's height
---@field attitudes? integer in [1, 1e+06], default 1500: of which those are taken that fit into the pattern, beside others
---@field nudges? integer in [0, 1e+05], default 200: steps of a unit on its way to rest, at most; 0: only lowered on to what is there, each by itself
---@field play? number in [0, 1], default 0.1: how far along the contour a unit may be from its place, over its height
---@field friction_angle? number deg, in [0, 90), default 15: friction angle with which the units come to rest. Units of the lowest row are held, by more than the slope's angle
---@field walls? boolean default false: at both ends of the rows walls stand along the slope, on which units lean; the pile's box ends there

---One layer of armour units on a slope, in the staggered pattern of a packing density. The units are laid row by row from the toe: each comes down above the gap between two units of the row below and slides against them. Then the units come to rest together under their weight with friction. The lowest row does not take part, as it is to be held.
---@param options cdem.PlaceOptions
---@return cdem.Pile
function cdem.place(options) end

---@class (exact) cdem.ReadPileOptions
---@field file string

---A pile that pile:save{} wrote.
---@param options cdem.ReadPileOptions
---@return cdem.Pile
function cdem.read_pile(options) end

cdem.select = {}

---@class (exact) cdem.SelectPlaneOptions
---@field point number[] m: any point of the plane
---@field normal number[] of any length

---Everything that lies on a plane.
---@param options cdem.SelectPlaneOptions
---@return cdem.Selection
function cdem.select.plane(options) end

---@class (exact) cdem.SelectBoxOptions
---@field min number[] m
---@field max number[] m

---Everything inside an axis-aligned box, its faces included.
---@param options cdem.SelectBoxOptions
---@return cdem.Selection
function cdem.select.box(options) end

---@class (exact) cdem.SelectUnitsOptions
---@field body string by name
---@field numbers integer[]

---Some of a body's units: those of a pile, the parts of a mesh, or blocks, counted from 1 in their order.
---@param options cdem.SelectUnitsOptions
---@return cdem.Selection
function cdem.select.units(options) end

---@class (exact) cdem.SelectFacesOptions
---@field name string
---@field body? string by name; all bodies that have such faces when left out

---Outer faces that mesh:faces{ name = ... } named before the model was made; in a pile, those of each unit. A fix of them holds all nodes on them.
---@param options cdem.SelectFacesOptions
---@return cdem.Selection
function cdem.select.faces(options) end

---Everything for whose undeformed place a function returns true.
---@param predicate fun(x: number, y: number, z: number): boolean
---@return cdem.Selection
function cdem.select.where(predicate) end

---@class (exact) cdem.ModelOptionsBodies
---@field shape cdem.Assembly|cdem.TetMesh|cdem.Pile blocks, a mesh of tetrahedra, or a pile of them
---@field material cdem.Material
---@field joint? cdem.Joint|fun(x: number, y: number, z: number): cdem.Joint between the body's own blocks; needed when there are several, or when they are cut. A mesh has it on its inner faces, which can break then. An assembly may have a function of the place instead, which returns a law. It is called once for each face between two blocks, with the centroid of the face, so that the law may vary with depth, region or seed
---@field joints? table<string, cdem.Joint|fun(x: number, y: number, z: number): cdem.Joint> of an assembly: laws by the name of the joint set or cut that made the faces, { bedding = joint, fault = joint }; `joint` holds all others
---@field name? string for selections and contacts; body_1, body_2 ... by default
---@field element? "small_strain"|"finite_volume"|"rigid" how its tetrahedra deform: finite_volume (Feng 2014) for any motion, the default; small_strain (Han 2010) of an assembly whose blocks hardly turn and keep the neighbours they begin with; rigid: keeps its shape until model:make_deformable
---@field zone_size? number m, > 0: of an assembly: each block gets tetrahedra of about this edge length inside, so that it bends and shows where it is stressed; without it a few about its centroid. Joints between blocks stay as they are
---@field bonds? "cohesive"|"springs"|"none"|"all"|"regions"|"listed" what holds the parts of a body with a joint together. cohesive, the default of a mesh: the body is continuous, with shared nodes, until a face nears its strength. The face then follows the joint's softening or brittle law. It is recommended for bonded blocks too: they become one mesh in which each block is a region and the joints are the borders of regions. A uniform stress stays uniform, and the blocks part at the strength of the joint. springs, the default of an assembly: springs at the corners of faces (Han 2010), with a thickness. Where three or more blocks meet in an edge they carry 0.9 to 1.7 of a uniform traction, so that the first bond breaks at about half the strength. A mesh has three springs on every bonded face (Feng 2014), which soften the body and break at 0.6 to 0.9 of its strength. all, regions and listed are old words for springs
---@field bonded_faces? "all"|"regions" of a mesh with a joint, the inner faces that may break: all, the default, or those between different regions
---@field bonded_regions? integer[] of a mesh with a joint, instead of bonded_faces: numbers of regions, from 1, whose faces may break
---@field region_joints? [integer, integer, cdem.Joint][] of a mesh: {region, region, joint} gives the faces between two regions, or with the same number twice those inside one, a joint of their own; numbers from 1. All others have `joint`
---@field plasticity? cdem.Plasticity of a body that moves far: its tetrahedra yield by this law, cdem.plastic{...} or cdem.hoek_brown{...}
---@field region_plasticity? [integer, cdem.Plasticity][] of a mesh: {region, law} gives a region a law of its own; numbers from 1. All others have `plasticity`, or are elastic without it
---@field stiffness_ratio? number > 0: of a mesh, beta in Kn = beta E A / (3 d). Springs have 10 by default; a body that is bonded everywhere keeps about E / (1 + 1/beta). A cohesive body has 1 by default, the penalty of freed faces, and keeps all of E
---@field shear_ratio? number > 0: of a mesh, Ks / Kn; 1 by default

---@class (exact) cdem.ModelOptions
---@field bodies cdem.ModelOptionsBodies[]
---@field contacts? [string, string, cdem.Joint][]|{default?: cdem.Joint} {"body a", "body b", joint} for every two bodies that touch; default = joint for all others

---A model: bodies of blocks, and what holds touching bodies to each other.
---@param options cdem.ModelOptions
---@return cdem.Model
function cdem.model(options) end

---@class (exact) cdem.WaterTableOptions
---@field point? number[] m: of a plane
---@field dip? number deg, in [0, 90): of a plane, below the horizontal
---@field dip_direction? number deg, in [0, 360]: clockwise from +y (north)
---@field profile? [number, number][] instead: rows {distance, z} (m); straight between them, level beyond, the same across
---@field points? number[][] m: instead: {x, y, z}, such as levels in boreholes; straight in the triangles of Delaunay between them
---@field file? string instead: a table (docs/output-files.md) with columns distance and z, or x, y and z (m)
---@field origin? number[] m: where the distance of a profile is 0; {0, 0, 0} when left out
---@field direction? number[] of a profile, horizontal; {1, 0, 0} when left out
---@field surface? cdem.Surface instead: open, once over each place; larger than the model in plan

---A water table that is not level, for model:water and model:traction: a plane, a profile along a direction, or a surface. Pressure is weight times the vertical depth below it (docs/theory.md, "Water").
---@param options? cdem.WaterTableOptions
---@return cdem.WaterTable
function cdem.water_table(options) end

---@class (exact) cdem.FactorOfSafetyOptions
---@field model? cdem.Model each trial starts from its state as it is; it stays as it is
---@field builder? fun(): cdem.Model instead: makes the model of a trial, called anew for each
---@field reduce ("joints"|"blocks")[] strengths that are divided: joints (cohesion, tan(phi) and tensile strength of joints, bonds and contacts), blocks (those of plasticity)
---@field lower? number > 0, default 0.5: a factor at which the model stands
---@field upper? number > 0, default 4: a factor at which it fails
---@field tolerance? number > 0, default 0.02: width of the bracket that is left
---@field residual? number in (0, 1), default 1e-05: goal of each relaxation; smaller for models of many blocks of which few slide
---@field max_steps? integer >= 1, default 200000: of each relaxation; a trial that is undecided then counts as failing, with a warning
---@field smallest? number m3, >= 0: volume of a mechanism that counts, 0 when left out: blocks that fail and are smaller together are removed from the trial, which goes on without them; their number is told
---@field picture? string file (.png) of the mechanism: displacement of the failing side, seen from where it moves to
---@field figure? string default "factor_of_safety": name of the figure in the report

---The factor of safety by strength reduction: the factor by which the strengths can be divided before the model fails, found by bisection. Each trial starts from the same state, with its displacement set to zero, and is relaxed; the verdict of model:relax says whether it stands. The log tells which blocks fail, where, and how large they are. Trials show in the progress, in the log and in report.json, which also gets the figures factor_of_safety, factor_of_safety_lower and factor_of_safety_upper.
---@param options cdem.FactorOfSafetyOptions
---@return cdem.FactorOfSafety
function cdem.factor_of_safety(options) end

cdem.water = {}

---@class (exact) cdem.WaterUniformOptions
---@field velocity number[]|fun(time: number): number[] m/s
---@field level? number m: z of the free surface, below which the pressure is hydrostatic; left out: water everywhere, no buoyancy
---@field density? number kg/m3, > 0, default 1025: sea water by default

---Water of one velocity everywhere below its level.
---@param options cdem.WaterUniformOptions
---@return cdem.Water
function cdem.water.uniform(options) end

---@class (exact) cdem.WaterFieldOptions
---@field velocity fun(x: number, y: number, z: number, time: number): number[] m/s
---@field acceleration? fun(x: number, y: number, z: number, time: number): number[] m/s2
---@field pressure? fun(x: number, y: number, z: number, time: number): number Pa: that of the motion included
---@field surface? fun(x: number, y: number, z: number, time: number): number m: z of the free surface; water everywhere when left out
---@field density? number kg/m3, > 0, default 1025: sea water by default

---Water described by functions of place and time, which are called at every node of a unit. Without a function for the pressure, the pressure is hydrostatic below the surface. Without a function for the acceleration, the acceleration follows from the velocity.
---@param options cdem.WaterFieldOptions
---@return cdem.Water
function cdem.water.field(options) end

---@class (exact) cdem.WaterWaveOptions
---@field theory? "stream_function"|"stokes"|"airy" default "stream_function"
---@field height number m, > 0: crest over trough
---@field period? number s, > 0: give it or length
---@field length? number m, > 0
---@field depth number m, > 0: of still water
---@field level? number m, default 0: z of still water
---@field direction? number[] default {1, 0, 0}: of travel, horizontal
---@field crest_at? number[] m, default {0, 0, 0}: where a crest stands at time 0
---@field current? number m/s, default 0: along the direction, mean under water
---@field order? integer in [3, 50], default 20: of the stream function
---@field density? number kg/m3, > 0, default 1025: sea water by default

---A regular wave over a flat bed that keeps its shape. stream_function: order N, any depth (Rienecker and Fenton 1981); stokes: fifth order (Fenton 1985), for waves that are not long; airy: small waves. A wave higher than the breaking limit is refused.
---@param options cdem.WaterWaveOptions
---@return cdem.Water
function cdem.water.wave(options) end

---@class (exact) cdem.WaterSeaOptions
---@field significant_height number m, > 0
---@field peak_period number s, > 0
---@field depth number m, > 0: of still water
---@field level? number m, default 0: z of still water
---@field peak_enhancement? number in [1, 20], default 3.3: gamma; 1: Pierson and Moskowitz
---@field direction? number[] default {1, 0, 0}: of travel, horizontal
---@field origin? number[] m, default {0, 0, 0}
---@field components? integer in [10, 10000], default 100
---@field seed? integer >= 0, default 1
---@field density? number kg/m3, > 0, default 1025: sea water by default

---An irregular sea of long crests: Airy waves whose energy follows the JONSWAP spectrum, with frequencies and phases drawn from the seed. Best as the waves of cdem.water.slope: at each node it sums all components.
---@param options cdem.WaterSeaOptions
---@return cdem.Water
function cdem.water.sea(options) end

---@class (exact) cdem.WaterSlopeOptions
---@field bed [number, number][] points {x, z} (m) from the sea up the slope, x along the direction from the origin
---@field waves cdem.Water|fun(time: number): number that enter over the first point: waves of the same level, or the height over still water (m)
---@field duration number s, > 0: a run may not go on beyond it
---@field level? number m, default 0: z of still water
---@field cell? number m, > 0: a 300th of the bed when left out
---@field ramp? number s, >= 0, default 0: over which the waves grow from nothing
---@field friction? number in [0, 10], default 0.01: f of the bed's resistance rho f u |u|: smooth 0.005, armour 0.02 to 0.1
---@field direction? number[] default {1, 0, 0}: of travel, horizontal
---@field origin? number[] m, default {0, 0, 0}
---@field density? number kg/m3, > 0, default 1025: sea water by default

---Waves that run up and down a slope: shallow water along the bed, computed once here. Velocity along the bed and the free surface, hydrostatic pressure. A breaking wave is a bore, without jet and without the pressure of its impact.
---@param options cdem.WaterSlopeOptions
---@return cdem.Water
function cdem.water.slope(options) end

---@class (exact) cdem.WaterFileOptions
---@field series? string a .pvd file, which lists files with their times; give it or files
---@field files? string[] in the order of their times
---@field times? number[] s: of the files
---@field velocity? string default "U": name of the array (m/s, three components), at points or in cells
---@field pressure? string name of the array: pressure above that of the air with its hydrostatic part, such as OpenFOAM's "p" ("p_rgh" lacks that part). Left out: hydrostatic below the surface
---@field pressure_factor? number > 0, default 1: Pa in a unit of it; the density where it is kinematic
---@field fraction? string name of the array of the water fraction, 0 to 1, such as "alpha.water"
---@field level? number m: z of the free surface where there is no fraction; left out: water everywhere
---@field cell? number m, > 0: of the grid; left out: that of a .vti, else the mean size of the cells
---@field same_along? "x"|"y"|"z" the water is the same all along this axis, as in a flume of one cell
---@field shift? number[] m, default {0, 0, 0}: is added to the coordinates
---@field time_shift? number s, default 0: is added to the times, such as the model's time at the start
---@field density? number kg/m3, > 0, default 1025: sea water by default

---Water that another program has computed, from VTK's files (.vti, .vtu, .vts, .vtr, legacy .vtk) at several times. It is put on a regular grid, and is linear between its points and times. The free surface is where the water fraction is 1/2. A run that asks beyond the box or the times of the files ends with an error. One file alone is water that does not change.
---@param options? cdem.WaterFileOptions
---@return cdem.Water
function cdem.water.file(options) end

---Pressure of a stream, rho V^2 / 2 (Feng 2014 eq 20), Pa.
---@param velocity number m/s, >= 0
---@param water_density? number kg/m3, > 0, default 1025: sea water by default
---@return number
function cdem.flow_pressure(velocity, water_density) end

---Velocity of a stream from its pressure, sqrt(2 F / rho), m/s.
---@param pressure number Pa, >= 0
---@param water_density? number kg/m3, > 0, default 1025: sea water by default
---@return number
function cdem.flow_velocity(pressure, water_density) end

---@class (exact) cdem.RecordOptions
---@field file string beside the script, in the output folder or below the results
---@field time? string default "time": name of its column (s); the number of it, "1", where the file has no names
---@field value? string name of its column; left out for a file .AT2
---@field scale? number default 1: factor on the values
---@field unit "m/s2"|"cm/s2"|"Gal"|"g"|"m/s"|"cm/s"|"Pa"|"kPa"|"MPa"|"1" of the values in the file
---@field to? "velocity" velocity: an acceleration is integrated
---@field baseline? "none"|"straight" default "none": straight: takes the line a0 + a1 t off the acceleration that brings the last velocity and the last displacement to zero
---@field longest_step? number s, > 0: two samples further apart are a gap; 2.5 times the median step when left out

---Reads a record over time from two columns of a table as spreadsheets write it, or from a file .AT2 of the PEER data base (unit = "g"), in SI units from then on; outside its times it is 0. Times must grow without gaps. With to = "velocity" an acceleration is integrated by the trapezoidal rule.
---@param options cdem.RecordOptions
---@return cdem.Record
function cdem.record(options) end

---Speed of waves along the free surface of a material, m/s: the exact root of Rayleigh's equation. A crack in tension cannot run faster.
---@param material cdem.Material
---@return number
function cdem.rayleigh_speed(material) end

---@class (exact) cdem.FilmOptions
---@field file string ends in .ogv, or in .mp4 where ffmpeg is installed; in the output folder
---@field frames string[] names of the pictures, in order
---@field frames_per_second? integer in [1, 120], default 12

---A film from pictures of one size: Ogg/Theora, or H.264 by the program ffmpeg.
---@param options cdem.FilmOptions
function cdem.film(options) end

---@class (exact) cdem.ChartOptionsSeries
---@field name string in the legend
---@field x (string|number|boolean)[]
---@field y (string|number|boolean)[] as many; nan leaves a gap
---@field right_axis? boolean default false: read y on the right
---@field style? "line"|"dashed"|"points"|"both" default "line"
---@field colour? number[] {red, green, blue}, each 0 .. 1

---@class (exact) cdem.ChartOptions
---@field file string ends in .png, .svg or .pdf; in the output folder
---@field series cdem.ChartOptionsSeries[]
---@field title? string _{...} and ^{...} set sub- and superscripts
---@field x_label? string ending in an SI unit, "opening (m)", the axis is shown with the prefix that suits: mm
---@field y_label? string
---@field right_label? string of the axis on the right
---@field log_x? boolean default false
---@field log_y? boolean default false
---@field log_right? boolean default false
---@field x_range? number[]
---@field y_range? number[]
---@field right_range? number[]
---@field legend? "auto"|"top_left"|"top_right"|"bottom_left"|"bottom_right"|"none" default "auto"
---@field size? number[] default {1600, 1200}: {width, height} in pixels; height 0: as high as it needs to be
---@field dpi? number in [10, 2400], default 300: pixels in an inch where it is printed: 1600 pixels are 135 mm wide at 300

---Line chart of lists of numbers.
---@param options cdem.ChartOptions
function cdem.chart(options) end

---@class (exact) cdem.StereonetOptionsPoles
---@field name string in the legend
---@field planes [number, number][] {dip, dip_direction} (deg) of each
---@field colour? number[] {red, green, blue}, each 0 .. 1

---@class (exact) cdem.StereonetOptionsDiscs
---@field id? integer >= 0: discs cut in the order of their ids; its place in the list when left out
---@field centre number[] m
---@field dip number deg, in [0, 90]
---@field dip_direction number deg, in [0, 360]
---@field radius number m, > 0
---@field set string name of its faces, for their law

---@class (exact) cdem.StereonetOptionsPlanes
---@field name string in the legend
---@field dip number deg, in [0, 90]
---@field dip_direction number deg, in [0, 360]
---@field dashed? boolean default false
---@field colour? number[] {red, green, blue}, each 0 .. 1

---@class (exact) cdem.StereonetOptions
---@field file string ends in .png, .svg or .pdf; in the output folder
---@field poles? cdem.StereonetOptionsPoles[]
---@field discs? cdem.StereonetOptionsDiscs[] joints of finite size; poles by set
---@field shape? cdem.Assembly blocks: poles of the planes that cut them, by joint set or name of the cut; glued cuts are no joints
---@field planes? cdem.StereonetOptionsPlanes[] great circles: slope faces, mean planes of sets
---@field title? string
---@field size? number[] default {1600, 1200}: {width, height} in pixels; height 0: as high as it needs to be
---@field dpi? number in [10, 2400], default 300: pixels in an inch where it is printed: 1600 pixels are 135 mm wide at 300

---Stereonet (Schmidt net, equal-area, lower hemisphere, north up): poles of joints with their scatter, great circles of planes. A table of the same name that ends in .csv has kind, name, dip, dip_direction and the place x, y of each pole on a net of radius 1.
---@param options cdem.StereonetOptions
function cdem.stereonet(options) end

---@class (exact) cdem.ReportOptionsfigures
---@field name string name of the figure, with its unit at the end, e.g. "side_ux_max_m"
---@field value? any number, text or boolean; leave out (nil) when there is none
---@field unit? string
---@field reference? any number, text or boolean to compare with
---@field kind? "formula"|"paper"|"fe"|"trial" where the reference comes from; a trial figure is shown and never judged
---@field source? string e.g. "Han 2010 fig 7"
---@field tolerance? number >= 0: allowed |value - reference| over |reference|
---@field tolerance_absolute? number >= 0: the same in the figure's unit, instead of tolerance

---Writes figures beside their references to report.json and report.md in the output folder. Further calls add figures; a name given again takes the place of the earlier one. Numbers that are not finite become null, with a warning. Booleans are judged by equality. The warnings of the run stand in the report too.
---@param figures cdem.ReportOptionsfigures[] the figures, in order
function cdem.report(figures) end

---Reads columns of numbers from a table as spreadsheets write it (docs/output-files.md); its first row has their names. Empty cells are nan.
---@param file string beside the script, in the output folder or below the results
---@return table<string, number[]> # lists by name
function cdem.read_csv(file) end

---@class (exact) cdem.WriteCsvOptionsColumns
---@field name string
---@field values (string|number|boolean)[] as many as in the others; nan leaves an empty cell

---@class (exact) cdem.WriteCsvOptions
---@field file string in the output folder
---@field columns cdem.WriteCsvOptionsColumns[]

---Writes columns of numbers.
---@param options cdem.WriteCsvOptions
function cdem.write_csv(options) end

---Writes a line to the log and the terminal.
---@param text string
function cdem.log(text) end

---Numbers at equal distances.
---@param first number
---@param last number
---@param count integer >= 2
---@return number[] # count numbers, both ends included
function cdem.linspace(first, last, count) end

---Any value as readable text, tables with their contents.
---@param value? any
---@return string
function cdem.describe(value) end

---Wall-clock time since the script began, s.
---@return number
function cdem.elapsed() end

---@class (exact) cdem.SweepOptions
---@field script string another .lua file beside this one
---@field set any[] one table of parameters per case, e.g. { { case = 1 }, { case = 2 } }
---@field jobs? integer in [1, 1024]: cases at a time; as many as there are processors for when left out
---@field threads? integer in [1, 1024], default 1: of each case

---Runs a script with many settings, as processes side by side. Each has its own folder in the output folder. All of them run the script, and the files that it requires by a name in quotes, as they are when the sweep begins; the folder swept/ keeps these. If the sweep is stopped, `cdem resume` continues it: runs that have ended well are kept, the others begin again. A failed run gives a warning. Scripts that are swept may sweep others, three deep.
---@param options cdem.SweepOptions
---@return cdem.SweepResult[] # in the order given
function cdem.sweep(options) end

return cdem
