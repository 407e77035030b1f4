import java.io.FileInputStream;
import java.io.InputStream;
import java.util.Map;
import java.util.TreeMap;

import org.verapdf.gf.foundry.VeraGreenfieldFoundryProvider;
import org.verapdf.pdfa.Foundries;
import org.verapdf.pdfa.PDFAParser;
import org.verapdf.pdfa.PDFAValidator;
import org.verapdf.pdfa.flavours.PDFAFlavour;
import org.verapdf.pdfa.results.TestAssertion;
import org.verapdf.pdfa.results.ValidationResult;

/**
 * Validate FILE FLAVOUR [FILE FLAVOUR ...]: flavours are 3u, ua1 and the like.
 *
 * Prints a line for each file, then one for each clause that it breaks: the clause, what it asks for, and where.
 */
public class Validate {
    private static final int MOST_FAILURES_OF_A_CLAUSE = 1;

    public static void main(String[] arguments) throws Exception {
        VeraGreenfieldFoundryProvider.initialise();
        for (int at = 0; at + 1 < arguments.length; at += 2) {
            validate(arguments[at], PDFAFlavour.fromString(arguments[at + 1]));
        }
    }

    private static void validate(String file, PDFAFlavour flavour) throws Exception {
        try (InputStream stream = new FileInputStream(file);
                PDFAParser parser = Foundries.defaultInstance().createParser(stream, flavour);
                PDFAValidator validator = Foundries.defaultInstance()
                        .createValidator(flavour, MOST_FAILURES_OF_A_CLAUSE, false, true, false)) {
            ValidationResult result = validator.validate(parser);
            System.out.println((result.isCompliant() ? "PASS " : "FAIL ") + flavour.getId() + " " + file);
            Map<String, String> failed = new TreeMap<>();
            for (TestAssertion one : result.getTestAssertions()) {
                if (one.getStatus() == TestAssertion.Status.FAILED) {
                    String clause = one.getRuleId().getClause() + " test " + one.getRuleId().getTestNumber();
                    failed.putIfAbsent(clause, one.getMessage() + " In " + one.getLocation().getContext());
                }
            }
            failed.forEach((clause, text) -> System.out.println("  " + clause + ": " + text.replace("\n", " ")));
        }
    }
}
