// The coefficients of Radau IIA of three stages (Hairer, Wanner, Solving Ordinary Differential Equations II, 2nd edition,
// IV.5 and IV.8).
#pragma once

#include "arithmetic/small_lu.hpp"

namespace radau {

constexpr double ROOT6 = 2.449489742783178098197284;
constexpr double C[3] = {0.1550510257216821901802716, 0.6449489742783178098197284, 1.0};
constexpr double A[3][3] = {
    {0.1968154772236604258683861, -0.06553542585019838810852278, 0.02377097434822015242040823},
    {0.3944243147390872769974117, 0.2920734116652284630205027, -0.04154875212599793019818601},
    {0.3764030627004672750500754, 0.5124858261884216138388134, 0.1111111111111111111111111}};

// The eigenvalues of A^-1, and A^-1 = T diag T^-1 with real rows for the complex pair.
constexpr double REAL = 3.637834252744495732208418513577776;
constexpr Complex PAIR = {2.681082873627752133895790743211112, -3.050430199247410569426377624787568};
constexpr double T[3][3] = {{0.09443876248897524, -0.14125529502095421, 0.03002919410514742},
                            {0.25021312296533332, 0.20412935229379994, -0.38294211275726192},
                            {1.0, 1.0, 0.0}};
constexpr double BACK[3][3] = {{4.178718591551904731529007, 0.3276828207610623536222130, 0.5233764454994495594071804},
                               {-4.178718591551904731529007, -0.3276828207610623536222130, 0.4766235545005504405928196},
                               {0.5028726349457869065830996, -2.571926949855605552201596, 0.5960392048282249757829144}};

// The estimate's weights of the stages' increments, and the powers 1 to 3 of the interpolation.
constexpr double E[3] = {(-13.0 - 7.0 * ROOT6) / 3.0, (-13.0 + 7.0 * ROOT6) / 3.0, -1.0 / 3.0};
constexpr double P[3][3] = {
    {(13.0 + 7.0 * ROOT6) / 3.0, (-23.0 - 22.0 * ROOT6) / 3.0, 10.0 / 3.0 + 5.0 * ROOT6},
    {(13.0 - 7.0 * ROOT6) / 3.0, (-23.0 + 22.0 * ROOT6) / 3.0, 10.0 / 3.0 - 5.0 * ROOT6},
    {1.0 / 3.0, -8.0 / 3.0, 10.0 / 3.0}};

// Iterations for the stages at most.
constexpr int ITERATIONS = 7;

}  // namespace radau
