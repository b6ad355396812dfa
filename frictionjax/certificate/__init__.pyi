from .certification import certify as certify
