"""All commands, in their group."""

from .command_group import main
from .cost_command import cost
from .design_command import design
from .friction_commands import explain, friction, nap
from .scene_commands import figures, scenes
from .study_command import study

for _command in (friction, nap, explain, study, cost, design, scenes, figures):
    main.add_command(_command)
