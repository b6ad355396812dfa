"""Rodas4P2, the scheme for loose accuracies."""

from typing import ClassVar

from .rosenbrock import AbstractRosenbrock, Tableau

# Six stages, order 4, stiffly accurate, L-stable; dense output of order 3.
# G. Steinebach, Improvement of Rosenbrock-Wanner method RODASP, in: Progress in
# Differential-Algebraic Equations II, Springer (2020).
_LAST = (7.089566927282776, 4.573591406461604, -8.423496976860259, -0.959280113459775)


class Rodas4P2(AbstractRosenbrock):
    """Rodas4P2 for a scalar state: six stages to Rodas5P's eight, for larger errors.

    At gamma = 1 and eps = 1e-3 it takes 40 steps a slip at tolerance 1e-3 for the error
    that Rodas5P makes with 56 at 1e-4; below tolerances of about 1e-5 Rodas5P is cheaper.
    """

    tableau: ClassVar[Tableau] = Tableau(
        order=4,
        gamma=0.25,
        a=(
            (),
            (3.0,),
            (0.906377755268814, -0.189707390391685),
            (3.758617027739064, 1.161741776019525, -0.849258085312803),
            _LAST,
            (*_LAST, 1.0),
        ),
        c=(
            (),
            (-12.0,),
            (-6.354581592719008, 0.338972550544623),
            (-8.575016317114033, -7.606483992117508, 12.224997650124820),
            (
                -5.888975457523102,
                -8.157396617841821,
                24.805546872612922,
                12.790401512796979,
            ),
            (
                -4.408651676063871,
                -6.692003137674639,
                24.625568527593117,
                16.627521966636085,
                -5.714285714285718,
            ),
        ),
        times=(0.0, 0.75, 0.321448134013046, 0.519745732277726, 1.0, 1.0),
        time_derivative=(0.25, -0.5, -0.189532918363016, 0.085612108792769, 0.0, 0.0),
        dense=(
            (
                -5.323528268423303,
                -10.042123754867493,
                17.175254928256965,
                -5.079931171878093,
                -0.016185991706112,
                0.0,
            ),
            (
                6.984505741529879,
                6.914061169603662,
                -0.849178943070653,
                18.104410789349338,
                -3.516963011559032,
                0.0,
            ),
        ),
    )
