from .friction_numbers import Coefficients as Coefficients
from .friction_numbers import with_errors as with_errors
from .named_numbers import COEFFICIENTS as COEFFICIENTS
from .named_numbers import OF_THE_BRISTLE as OF_THE_BRISTLE
from .named_numbers import coefficient_table as coefficient_table
from .named_numbers import coefficients_by_name as coefficients_by_name
from .named_numbers import errors_by_name as errors_by_name
from .named_numbers import meaning_of as meaning_of
